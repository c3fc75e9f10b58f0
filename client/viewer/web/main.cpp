// What the page's script calls. Each takes and gives JSON as text; what is given back is valid
// until the next call.
//
//   earthwork_start(options)   once: "" when it runs, or {"field", "message"}
//   earthwork_command(command) as of panel_command.hpp: "" when it was done, or the same
//   earthwork_screenshot()     draws now, so that the canvas can be read in the same task
//   earthwork_figures()        as of figures.hpp
#include <emscripten.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "client/viewer/web/page.hpp"
#include "client/viewer/web/start_options.hpp"

namespace earthwork::viewer {
namespace {

std::unique_ptr<Page>& the_page() {
  static std::unique_ptr<Page> page;
  return page;
}

const char* give_back(std::string text) {
  static std::string given;
  given = std::move(text);
  return given.c_str();
}

const char* answer(const protocol::Result<void>& result) {
  if (result) return "";
  const protocol::Failure& failure = result.error();
  return give_back(
      nlohmann::ordered_json{{"field", failure.field}, {"message", failure.detail}}.dump());
}

protocol::Result<void> start(const char* json) {
  if (the_page()) return protocol::fail(protocol::Code::bad_state, "The viewer runs already.");
  auto options = read_start_options(json);
  if (!options) return tl::unexpected<protocol::Failure>(std::move(options.error()));
  auto page = Page::open(std::move(*options));
  if (!page) return tl::unexpected<protocol::Failure>(std::move(page.error()));
  the_page() = std::move(*page);
  return {};
}

protocol::Result<void> command(const char* json) {
  if (!the_page()) return protocol::fail(protocol::Code::bad_state, "The viewer does not run yet.");
  return the_page()->command(json);
}

}  // namespace
}  // namespace earthwork::viewer

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* earthwork_start(const char* options) {
  return earthwork::viewer::answer(earthwork::viewer::start(options));
}

EMSCRIPTEN_KEEPALIVE const char* earthwork_command(const char* command) {
  return earthwork::viewer::answer(earthwork::viewer::command(command));
}

EMSCRIPTEN_KEEPALIVE void earthwork_screenshot() {
  if (auto& page = earthwork::viewer::the_page()) page->draw();
}

EMSCRIPTEN_KEEPALIVE const char* earthwork_figures() {
  auto& page = earthwork::viewer::the_page();
  return earthwork::viewer::give_back(page ? page->figures() : "{}");
}
}
