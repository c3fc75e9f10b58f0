/// What can go wrong with input, and the way it is handed back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace earthwork::protocol {

/// Why something was refused; `name(code)` is what a client is told.
enum class Code : std::uint8_t {
  bad_json,      ///< Not JSON, or nested too deep.
  bad_message,   ///< JSON, but not a message that is understood here.
  bad_field,     ///< A field is missing, of the wrong type, or not a finite number.
  out_of_range,  ///< A field is beyond its limit.
  too_large,     ///< The message or the work it asks for is.
  bad_frame,     ///< A binary message that does not follow the format.
  bad_version,   ///< No protocol version in common.
  bad_state,     ///< The message is not for now: an edit before a join, say.
  unknown_map,
  map_exists,
  bad_name,
  id_too_old,       ///< The id is older than all that are remembered.
  id_out_of_order,  ///< The id is below one that was applied already, and was not applied itself.
  not_supported,    ///< Understood, and not offered by this server.
  timeout,          ///< Nothing was heard for too long.
  shutting_down,    ///< The server ends.
  disk_full,        ///< There is no room to store it now.
  read_only,        ///< The server may not write where it stores.
  storage_failed,   ///< Storing or reading failed for another reason.
  damaged,          ///< What was stored is not what is there.
  unavailable,      ///< Not to be had right now.
  too_fast,         ///< More of it than may be asked for in a while.
  internal,
};

/// The code in lower case with underscores, as in the enum.
[[nodiscard]] std::string_view name(Code code);
/// The code of that name; `internal` for a name that is not known here.
[[nodiscard]] Code code_named(std::string_view name);

/// `detail` is a sentence for people that names the field and the limit; `field` is the field's
/// name or empty.
struct Failure {
  Code code = Code::internal;
  std::string detail;
  std::string field;
  friend bool operator==(const Failure&, const Failure&) = default;
};

template <class T>
using Result = tl::expected<T, Failure>;

[[nodiscard]] inline tl::unexpected<Failure> fail(Code code, std::string detail,
                                                  std::string field = {}) {
  return tl::unexpected<Failure>(Failure{code, std::move(detail), std::move(field)});
}

}  // namespace earthwork::protocol
