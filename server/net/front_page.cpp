#include "server/net/front_page.hpp"

#include "server/net/page_headers.hpp"

namespace earthwork::net {
namespace {

constexpr const char* kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

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
<p>This is an Earthwork server, and the viewer for the browser is not among its files. From the
sources <code>server/run</code> builds the viewer and serves it here; a viewer that was built
before is served with <code>earthwork-server serve --page FOLDER</code>. Without it maps are
painted and watched with <code>earthwork-bot</code>.</p>
<p>What is offered over HTTP:</p>
<ul>
  <li><a href="/api/maps">/api/maps</a>: the maps of this server; <code>POST</code> makes one</li>
  <li><code>/api/maps/NAME</code>: one map; <code>DELETE</code> removes it</li>
  <li><code>/api/maps/NAME/figures</code>: what it consists of, in numbers</li>
  <li><code>/api/maps/NAME/states.png</code>: its voxels as a picture</li>
  <li><code>/api/maps/NAME/export.glb</code>: its mesh, as glTF</li>
  <li><code>/ws</code>, subprotocol <code>earthwork.v1</code>: painting and watching</li>
  <li><a href="/healthz">/healthz</a>: whether the server lives</li>
  <li><a href="/metrics">/metrics</a>: how it does, for Prometheus</li>
</ul>
<p>All of it is specified in <code>protocol/README.md</code>.</p>
</html>
)";

}  // namespace

HttpResponse front_page() {
  HttpResponse response{
      .status = 200, .content_type = "text/html; charset=utf-8", .headers = {}, .body = kPage};
  add_page_headers(response, kPolicy);
  return response;
}

}  // namespace earthwork::net
