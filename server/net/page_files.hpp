/// The page of the browser viewer: the files that a build left in a folder, as they are served.
///
/// They are read once, when the server starts. A request only ever picks a name from this table, so
/// whatever it asks for, nothing else of the disk can be reached.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/result.hpp"
#include "server/net/http_message.hpp"

namespace earthwork::net {

inline constexpr std::size_t kMaxPageFiles = 128;                    ///< NAME and NAME.gz are two.
inline constexpr std::size_t kMaxPageBytes = std::size_t{16} << 20;  ///< Of all files together.

/// Any thread.
class PageFiles {
 public:
  /// Reads `folder`: plain files with names of letters, digits, '-', '_' and '.', among them
  /// index.html; names that begin with '.' are passed over. NAME.gz is NAME compressed by gzip.
  /// Fails with bad_field when the folder is not like that (a folder or a link in it, a NAME.gz
  /// that is not of NAME), with too_large beyond the limits, with storage_failed when it cannot be
  /// read. Every sentence names the folder or the file.
  [[nodiscard]] static protocol::Result<PageFiles> read(const std::filesystem::path& folder);

  /// The answer to a GET or HEAD of a file: 200, or 304 when the client has these bytes. Nothing
  /// when there is no file of that name. A file whose name holds a hash of its content (a part of 8
  /// to 16 hex digits before the last one: viewer.0a1b2c3d.js) may be kept for good; of every other
  /// one the client has to ask whether it is still the same.
  [[nodiscard]] std::optional<HttpResponse> answer(std::string_view name,
                                                   const HttpRequest& request) const;

 private:
  /// One form of a file, as it goes over the wire.
  struct Form {
    SharedBody bytes;
    std::string tag;  ///< ETag, quotes included.
  };
  struct File {
    std::string content_type;
    bool hashed = false;  ///< The name is another one when the content is.
    Form plain;
    std::optional<Form> gzip;
  };

  [[nodiscard]] static Form make_form(std::string bytes);

  std::map<std::string, File, std::less<>> files_;
};

}  // namespace earthwork::net
