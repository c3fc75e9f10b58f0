/// The HTTP interface: from a request to its answer, without sockets.
#pragma once

#include <memory>
#include <optional>

#include "server/net/access.hpp"
#include "server/net/http_message.hpp"
#include "server/net/map_question.hpp"
#include "server/net/page_files.hpp"
#include "server/net/target.hpp"
#include "server/net/workers.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::net {

class Survey;

/// Of a request's body.
inline constexpr std::size_t kMaxBodyBytes = 64 * 1024;

/// Any thread.
class Api {
 public:
  /// Atlas and workers must outlive it, and every request. `page` is served at '/'; null: a page
  /// there tells how to get it.
  Api(room::Atlas& atlas, Workers& workers, Access access,
      std::shared_ptr<const PageFiles> page = nullptr);

  /// Answers through `respond`, exactly once, now or later. Requests that this server's name
  /// was not used for, or that come from another site, are answered 403.
  void handle(HttpRequest request, Respond respond) const;

  /// The answer to a request that may not come here at all, be it for a page or a WebSocket: 400
  /// without exactly one Host header, 403 under a name that is not the server's, or from another
  /// site. Nothing for every other one.
  [[nodiscard]] std::optional<HttpResponse> refuse_access(const HttpRequest& request) const;

 private:
  /// '/', or a file of the page; nothing for every other path.
  [[nodiscard]] std::optional<HttpResponse> page_answer(const HttpRequest& request,
                                                        const Target& target) const;
  void handle_maps(const HttpRequest& request, Respond respond) const;
  void handle_map(const HttpRequest& request, const Target& target, Respond respond) const;
  void create_map(const HttpRequest& request, Respond respond) const;
  void delete_map(const HttpRequest& request, const std::string& name, Respond respond) const;
  /// What a GET of this part of a map asks; fails with bad_field.
  [[nodiscard]] protocol::Result<Question> map_question(const HttpRequest& request,
                                                        const Target& target,
                                                        const std::string& part) const;
  void list_maps(const Respond& respond) const;
  void give_metrics(Respond respond) const;

  room::Atlas& atlas_;
  const std::shared_ptr<Survey> survey_;
  Workers& workers_;
  Access access_;
  const std::shared_ptr<const PageFiles> page_;
};

}  // namespace earthwork::net
