// A SAX consumer builds the tree itself: only so can depth be refused before there is a tree, and
// a number that float64 cannot hold be told apart from text that is not JSON.
#include "protocol/json_text.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

constexpr int kNumberOverflow = 406;  // nlohmann's id of it

Failure too_deep() {
  return {Code::bad_json, "nested deeper than the limit of " + std::to_string(kMaxJsonDepth), {}};
}

class TreeBuilder {
 public:
  bool null() { return put(nullptr); }
  bool boolean(bool value) { return put(value); }
  bool number_integer(std::int64_t value) { return put(value); }
  bool number_unsigned(std::uint64_t value) { return put(value); }
  bool number_float(double value, const std::string&) { return put(value); }
  bool string(std::string& value) { return put(std::move(value)); }
  bool binary(json::binary_t&) { return false; }
  bool key(std::string& value) {
    key_ = std::move(value);
    return true;
  }
  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool parse_error(std::size_t position, const std::string&, const json::exception& error) {
    if (error.id == kNumberOverflow) {
      failure_ = {Code::bad_field, "a number does not fit into a 64-bit float", key_};
      if (!key_.empty() && key_.size() <= kMaxNameBytes)
        failure_.detail = key_ + ": the number does not fit into a 64-bit float";
      else
        failure_.field.clear();
    } else {
      failure_ = {Code::bad_json, "not JSON from byte " + std::to_string(position) + " on", {}};
    }
    return false;
  }

  json take_tree() { return std::move(root_); }
  Failure take_failure() { return std::move(failure_); }

 private:
  template <class T>
  json* place(T&& value) {
    if (open_.empty()) return &(root_ = std::forward<T>(value));
    json& parent = *open_.back();
    if (parent.is_array()) return &parent.emplace_back(std::forward<T>(value));
    return &(parent[key_] = std::forward<T>(value));
  }
  template <class T>
  bool put(T&& value) {
    place(std::forward<T>(value));
    return true;
  }
  bool open(json&& container) {
    if (open_.size() == static_cast<std::size_t>(kMaxJsonDepth)) {
      failure_ = too_deep();
      return false;
    }
    // Pointers to open containers stay good: only the innermost one grows.
    open_.push_back(place(std::move(container)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  json root_;
  std::vector<json*> open_;
  std::string key_;
  Failure failure_{Code::bad_json, "not JSON", {}};
};

/// Looks for the "id" of the outermost object and builds nothing.
class IdFinder {
 public:
  bool null() { return other(); }
  bool boolean(bool) { return other(); }
  bool number_integer(std::int64_t) { return other(); }  // negative ones only
  bool number_unsigned(std::uint64_t value) {
    if (!at_id_) return true;
    at_id_ = false;
    id_.reset();
    if (value >= 1 && value <= static_cast<std::uint64_t>(kMaxInteger))
      id_ = static_cast<std::int64_t>(value);
    return true;
  }
  bool number_float(double, const std::string&) { return other(); }
  bool string(std::string&) { return other(); }
  bool binary(json::binary_t&) { return false; }
  bool key(std::string& value) {
    at_id_ = depth_ == 1 && value == "id";
    return true;
  }
  bool start_object(std::size_t) { return open(); }
  bool start_array(std::size_t) { return open() && depth_ > 1; }
  bool end_object() { return --depth_, true; }
  bool end_array() { return --depth_, true; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) { return false; }

  std::optional<MessageId> id() const { return id_; }

 private:
  bool other() {
    if (at_id_) id_.reset();
    at_id_ = false;
    return true;
  }
  bool open() {
    other();
    return ++depth_ <= kMaxJsonDepth;
  }

  int depth_ = 0;
  bool at_id_ = false;
  std::optional<MessageId> id_;
};

}  // namespace

// The library takes a NUL for the end of the text; JSON has none anywhere.
Result<json> parse_json(std::string_view text, std::size_t max_bytes) {
  if (text.size() > max_bytes)
    return fail(Code::too_large, std::to_string(text.size()) + " bytes are beyond the limit of " +
                                     std::to_string(max_bytes));
  if (const auto nul = text.find('\0'); nul != text.npos)
    return fail(Code::bad_json, "not JSON from byte " + std::to_string(nul + 1) + " on");
  TreeBuilder builder;
  if (!json::sax_parse(text.begin(), text.end(), &builder))
    return tl::unexpected<Failure>(builder.take_failure());
  return builder.take_tree();
}

std::optional<MessageId> salvage_id(std::string_view text) {
  if (text.size() > kMaxControlBytes) return std::nullopt;
  IdFinder finder;
  json::sax_parse(text.begin(), text.end(), &finder);
  return finder.id();
}

}  // namespace earthwork::protocol
