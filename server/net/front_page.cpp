#include "server/net/front_page.hpp"

namespace earthwork::net {
namespace {

constexpr const char* kPage = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Earthwork</title>
<style>
  body { font: 16px/1.5 system-ui, sans-serif; max-width: 42em; margin: 3em auto; padding: 0 1em;
         color: #222; background: #fbfaf7 }
  code { background: #eee9dd; padding: 0.1em 0.3em; border-radius: 3px }
</style>
<h1>Earthwork</h1>
<p>This is an Earthwork server. The browser viewer is not part of this build; maps are painted and
watched with <code>earthwork-bot</code>.</p>
<ul>
  <li><a href="/api/maps">/api/maps</a>: the maps of this server</li>
  <li><code>/api/maps/NAME</code>, <code>/figures</code>, <code>/states.png</code> and
      <code>/export.glb</code> below it: one map</li>
  <li><code>/ws</code>, subprotocol <code>earthwork.v1</code>: painting and watching</li>
  <li><a href="/healthz">/healthz</a></li>
</ul>
<p>All of it is specified in <code>protocol/README.md</code>.</p>
</html>
)";

}  // namespace

HttpResponse front_page() {
  return {.status = 200,
          .content_type = "text/html; charset=utf-8",
          .headers = {{"Content-Security-Policy", "default-src 'none'; style-src 'unsafe-inline'"},
                      {"X-Content-Type-Options", "nosniff"}},
          .body = kPage};
}

}  // namespace earthwork::net
