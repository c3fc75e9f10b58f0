#include "protocol/json_fields.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "protocol/settings.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

/// Nothing unless `value` is an integer within int64.
std::optional<std::int64_t> as_integer(const json& value) {
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() &&
      value.get<std::uint64_t>() > static_cast<std::uint64_t>(kMaxInteger) * 2)
    return kMaxInteger * 2;  // beyond every range there is
  return value.get<std::int64_t>();
}

bool is_hex_digit(char c) { return ('0' <= c && c <= '9') || ('a' <= c && c <= 'f'); }

bool is_hex(std::string_view text, std::size_t digits) {
  return text.size() == digits && std::all_of(text.begin(), text.end(), is_hex_digit);
}

std::string hex_sentence(std::size_t digits) {
  return "is not " + std::to_string(digits) + " hex digits in lower case";
}

/// Code points of valid UTF-8: bytes that do not continue one.
std::size_t count_characters(std::string_view utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// C0, DEL and C1, which UTF-8 writes as 0x00-0x1F, 0x7F and 0xC2 0x80-0x9F.
bool has_control_character(std::string_view utf8) {
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    if (byte < 0x20 || byte == 0x7F) return true;
    if (byte == 0xC2 && i + 1 < utf8.size() && static_cast<unsigned char>(utf8[i + 1]) < 0xA0)
      return true;
  }
  return false;
}

std::string range_sentence(IntegerRange range) {
  return "is outside " + std::to_string(range.min) + " .. " + std::to_string(range.max);
}

}  // namespace

std::string plain(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

JsonFields::JsonFields(const json& json, std::string parent, Code not_object)
    : json_(json), parent_(std::move(parent)) {
  if (json_.is_object()) return;
  failure_ =
      Failure{not_object, (parent_.empty() ? "" : parent_ + ": ") + "not a JSON object", parent_};
}

bool JsonFields::has(const char* key) const {
  if (!json_.is_object()) return false;
  const auto found = json_.find(key);
  return found != json_.end() && !found->is_null();
}

const json* JsonFields::value(const char* key) {
  if (failure_) return nullptr;
  const auto found = json_.find(key);
  if (found != json_.end() && !found->is_null()) return &*found;
  refuse(Code::bad_field, key, "is missing");
  return nullptr;
}

double JsonFields::number(const char* key) {
  const json* found = value(key);
  if (!found) return 0;
  if (found->is_number()) return found->get<double>();
  refuse(Code::bad_field, key, "is not a number");
  return 0;
}

std::int64_t JsonFields::integer(const char* key, IntegerRange range) {
  const json* found = value(key);
  if (!found) return 0;
  const auto integer = as_integer(*found);
  if (!integer) {
    refuse(Code::bad_field, key, "is not an integer");
  } else if (*integer < range.min || *integer > range.max) {
    refuse(Code::out_of_range, key, range_sentence(range));
  } else {
    return *integer;
  }
  return 0;
}

bool JsonFields::boolean(const char* key) {
  const json* found = value(key);
  if (!found) return false;
  if (found->is_boolean()) return found->get<bool>();
  refuse(Code::bad_field, key, "is not true or false");
  return false;
}

std::string JsonFields::text(const char* key) {
  const json* found = value(key);
  if (!found) return {};
  if (found->is_string()) return found->get<std::string>();
  refuse(Code::bad_field, key, "is not a string");
  return {};
}

std::string JsonFields::words(const char* key, std::size_t most) {
  std::string words = text(key);
  if (failed()) return {};
  const std::size_t characters = count_characters(words);
  if (characters < 1 || characters > most)
    refuse(
        Code::out_of_range, key,
        "has " + std::to_string(characters) + " characters, outside 1 .. " + std::to_string(most));
  else if (has_control_character(words))
    refuse(Code::bad_field, key, "holds a control character");
  return words;
}

std::string JsonFields::name(const char* key) { return words(key, kMaxNameCharacters); }

std::string JsonFields::color(const char* key) {
  std::string color = text(key);
  for (char& c : color)
    if ('A' <= c && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
  const bool good = color.size() == 7 && color[0] == '#' &&
                    std::all_of(color.begin() + 1, color.end(), is_hex_digit);
  if (!good) refuse(Code::bad_field, key, "is not a colour like \"#8a9a5b\"");
  return color;
}

std::string JsonFields::hex_digits(const char* key, std::size_t digits) {
  std::string hex = text(key);
  if (!is_hex(hex, digits)) refuse(Code::bad_field, key, hex_sentence(digits));
  return hex;
}

std::vector<std::string> JsonFields::hex_list(const char* key, std::size_t digits,
                                              std::size_t max) {
  std::vector<std::string> list;
  const json* found = array(key, 0, max);
  if (!found) return list;
  list.reserve(found->size());
  for (const json& element : *found) {
    const auto* hex = element.get_ptr<const std::string*>();
    if (!hex || !is_hex(*hex, digits)) {
      refuse(Code::bad_field, key,
             "element " + std::to_string(list.size()) + " " + hex_sentence(digits));
      return list;
    }
    list.push_back(*hex);
  }
  return list;
}

std::string JsonFields::map_name(const char* key) {
  std::string name = text(key);
  if (!valid_map_name(name))
    refuse(Code::bad_name, key, "is not 1-64 characters of a-z, 0-9, '-' and '_'");
  return name;
}

const json* JsonFields::array(const char* key, std::size_t min, std::size_t max) {
  const json* found = value(key);
  if (!found) return nullptr;
  if (!found->is_array()) {
    refuse(Code::bad_field, key, "is not an array");
    return nullptr;
  }
  if (found->size() >= min && found->size() <= max) return found;
  const std::string bounds =
      min == max ? "are not " + std::to_string(min)
                 : "are outside " + std::to_string(min) + " .. " + std::to_string(max);
  refuse(min == max ? Code::bad_field : Code::out_of_range, key,
         std::to_string(found->size()) + " elements " + bounds);
  return nullptr;
}

std::vector<double> JsonFields::numbers(const char* key, std::size_t count) {
  std::vector<double> numbers(count);
  const json* found = array(key, count, count);
  if (!found) return numbers;
  for (std::size_t i = 0; i < count; ++i) {
    if ((*found)[i].is_number())
      numbers[i] = (*found)[i].get<double>();
    else
      refuse(Code::bad_field, key, "element " + std::to_string(i) + " is not a number");
  }
  return numbers;
}

std::vector<std::int64_t> JsonFields::integers(const char* key, std::size_t count,
                                               IntegerRange range) {
  std::vector<std::int64_t> integers(count);
  const json* found = array(key, count, count);
  if (!found) return integers;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string element = "element " + std::to_string(i) + " ";
    const auto integer = as_integer((*found)[i]);
    if (!integer)
      refuse(Code::bad_field, key, element + "is not an integer");
    else if (*integer < range.min || *integer > range.max)
      refuse(Code::out_of_range, key, element + range_sentence(range));
    else
      integers[i] = *integer;
  }
  return integers;
}

std::string JsonFields::path(std::string_view key) const {
  if (parent_.empty()) return std::string(key);
  return parent_ + "." + std::string(key);
}

void JsonFields::refuse(Code code, std::string_view key, std::string_view sentence) {
  if (failure_) return;
  std::string field = path(key);
  failure_ = Failure{code, field + ": " + std::string(sentence), field};
}

void JsonFields::refuse(Failure failure) {
  if (!failure_) failure_ = std::move(failure);
}

}  // namespace earthwork::protocol
