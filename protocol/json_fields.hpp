/// Typed, bounded fields of one JSON object: the place where JSON becomes values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/result.hpp"

namespace earthwork::protocol {

struct IntegerRange {
  std::int64_t min = 0, max = kMaxInteger;
};

/// Reads fields one after the other and keeps the first failure; after one, reads give back
/// zeros. So a message is read straight down and `result` asked once:
///
///     JsonFields in(json);
///     Cursor cursor{.x = in.number("x"), .y = in.number("y")};
///     return in.result(cursor);
///
/// null counts as missing. A field that is asked for and missing is a failure; ask `has` first for
/// an optional one. Failures name the field, with `parent` before it ("layers[2].name").
class JsonFields {
 public:
  /// `json` is kept by reference. Fails with `not_object` when it is none.
  explicit JsonFields(const nlohmann::json& json, std::string parent = {},
                      Code not_object = Code::bad_field);

  [[nodiscard]] bool has(const char* key) const;

  double number(const char* key);
  std::int64_t integer(const char* key, IntegerRange range = {});
  bool boolean(const char* key);
  /// As it stands, in valid UTF-8.
  std::string text(const char* key);
  /// 1 .. `most` characters (code points), none of them a control character.
  std::string words(const char* key, std::size_t most);
  /// 1 .. 64 such characters.
  std::string name(const char* key);
  /// "#rrggbb", made lower case.
  std::string color(const char* key);
  /// Exactly `digits` hex digits, lower case.
  std::string hex_digits(const char* key, std::size_t digits);
  /// An array of up to `max` such strings.
  std::vector<std::string> hex_list(const char* key, std::size_t digits, std::size_t max);
  /// A map's name; bad_name otherwise.
  std::string map_name(const char* key);
  /// An array of exactly `count` numbers.
  std::vector<double> numbers(const char* key, std::size_t count);
  /// An array of exactly `count` integers.
  std::vector<std::int64_t> integers(const char* key, std::size_t count, IntegerRange range);
  /// An array of `min` .. `max` elements; null after a failure.
  const nlohmann::json* array(const char* key, std::size_t min, std::size_t max);
  /// The field itself; null when it is missing or after a failure.
  const nlohmann::json* value(const char* key);

  /// The field's name with its parent before it.
  [[nodiscard]] std::string path(std::string_view key) const;
  /// Unless something failed already: `detail` is "<field>: <sentence>".
  void refuse(Code code, std::string_view key, std::string_view sentence);
  void refuse(Failure failure);
  [[nodiscard]] bool failed() const { return failure_.has_value(); }

  template <class T>
  [[nodiscard]] Result<T> result(T value) {
    if (failure_) return tl::unexpected<Failure>(std::move(*failure_));
    return value;
  }

 private:
  const nlohmann::json& json_;
  std::string parent_;
  std::optional<Failure> failure_;
};

/// A finite number as people write it: 600, 0.25, 1e+06.
[[nodiscard]] std::string plain(double value);

}  // namespace earthwork::protocol
