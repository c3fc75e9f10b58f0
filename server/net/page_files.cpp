#include "server/net/page_files.hpp"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cstdint>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "server/net/content_coding.hpp"
#include "server/net/entity_tag.hpp"
#include "server/net/page_headers.hpp"

namespace earthwork::net {
namespace {

using protocol::Code;
using protocol::fail;
using protocol::Result;

constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
    "img-src 'self' data: blob:; connect-src 'self'; manifest-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";
constexpr std::string_view kGzip = ".gz";

std::string_view ending_of(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : name.substr(dot + 1);
}

const char* content_type_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 10> kTypes{{
      {"html", "text/html; charset=utf-8"},
      {"css", "text/css; charset=utf-8"},
      {"js", "text/javascript; charset=utf-8"},
      {"mjs", "text/javascript; charset=utf-8"},
      {"wasm", "application/wasm"},
      {"svg", "image/svg+xml"},
      {"png", "image/png"},
      {"ico", "image/x-icon"},
      {"webmanifest", "application/manifest+json"},
      {"txt", "text/plain; charset=utf-8"},
  }};
  for (const auto& [ending, type] : kTypes)
    if (ending_of(name) == ending) return type;
  return "application/octet-stream";
}

bool is_hex(char c) { return ('0' <= c && c <= '9') || ('a' <= c && c <= 'f'); }

/// viewer.0a1b2c3d.js does.
bool holds_hash(std::string_view name) {
  const std::size_t last = name.rfind('.');
  if (last == std::string_view::npos || last == 0) return false;
  const std::size_t first = name.rfind('.', last - 1);
  if (first == std::string_view::npos || first == 0) return false;
  const std::string_view part = name.substr(first + 1, last - first - 1);
  return part.size() >= 8 && part.size() <= 16 && std::all_of(part.begin(), part.end(), is_hex);
}

bool is_name(std::string_view name) {
  return std::all_of(name.begin(), name.end(), [](char c) {
    return ('0' <= c && c <= '9') || ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '-' ||
           c == '_' || c == '.';
  });
}

/// The names in the folder, in order, but for those that begin with '.'.
Result<std::vector<std::string>> names_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (name.starts_with('.')) continue;
    if (!is_name(name))
      return fail(Code::bad_field,
                  (folder / name).string() + ": a name has letters, digits, '-', '_' and '.' only");
    names.push_back(std::move(name));
    if (names.size() > kMaxPageFiles)
      return fail(Code::too_large,
                  folder.string() + ": has more than " + std::to_string(kMaxPageFiles) + " files");
  }
  if (error) return fail(Code::storage_failed, folder.string() + ": " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

/// The bytes of a plain file of up to `most` bytes.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t most) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);  // a link is not followed
  if (!error && !std::filesystem::is_regular_file(status))
    return fail(Code::bad_field, path.string() + ": is not a plain file");
  const std::uintmax_t size = error ? 0 : std::filesystem::file_size(path, error);
  if (error) return fail(Code::storage_failed, path.string() + ": " + error.message());
  if (size > most)
    return fail(Code::too_large, path.string() + ": the folder's files have more than " +
                                     std::to_string(kMaxPageBytes) + " bytes");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    return fail(Code::storage_failed, path.string() + ": cannot be read");
  return bytes;
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Whether the end of a gzip file says that it is of these bytes: one of an earlier build is not.
/// Source: RFC 1952, 2.2 and 2.3.
bool is_gzip_of(const std::string& gzip, const std::string& plain) {
  constexpr std::size_t kLeast = 18;
  if (gzip.size() < kLeast || !gzip.starts_with("\x1f\x8b\x08")) return false;
  boost::crc_32_type crc;
  crc.process_bytes(plain.data(), plain.size());
  return u32_at(gzip, gzip.size() - 8) == crc.checksum() &&
         u32_at(gzip, gzip.size() - 4) == static_cast<std::uint32_t>(plain.size());
}

}  // namespace

PageFiles::Form PageFiles::make_form(std::string bytes) {
  std::string tag = "\"" + protocol::hex(XXH3_64bits(bytes.data(), bytes.size())) + "-" +
                    std::to_string(bytes.size()) + "\"";
  return {std::make_shared<const std::string>(std::move(bytes)), std::move(tag)};
}

Result<PageFiles> PageFiles::read(const std::filesystem::path& folder) {
  const auto names = names_in(folder);
  if (!names) return tl::unexpected<protocol::Failure>(names.error());
  PageFiles page;
  std::size_t left = kMaxPageBytes;
  // In order of their names: NAME comes before NAME.gz.
  for (const std::string& name : *names) {
    auto bytes = read_file(folder / name, left);
    if (!bytes) return tl::unexpected<protocol::Failure>(std::move(bytes.error()));
    left -= bytes->size();
    if (!name.ends_with(kGzip)) {
      page.files_[name] = {.content_type = content_type_of(name),
                           .hashed = holds_hash(name),
                           .plain = make_form(std::move(*bytes)),
                           .gzip = {}};
      continue;
    }
    const auto of = page.files_.find(name.substr(0, name.size() - kGzip.size()));
    if (of == page.files_.end() || !is_gzip_of(*bytes, *of->second.plain.bytes))
      return fail(Code::bad_field,
                  (folder / name).string() + ": is not the file without .gz compressed by gzip");
    of->second.gzip = make_form(std::move(*bytes));
  }
  if (!page.files_.contains("index.html"))
    return fail(Code::bad_field, folder.string() + ": has no index.html");
  return page;
}

std::optional<HttpResponse> PageFiles::answer(std::string_view name,
                                              const HttpRequest& request) const {
  const auto found = files_.find(name);
  if (found == files_.end()) return std::nullopt;
  const File& file = found->second;
  const bool gzip = file.gzip && prefers_gzip(request.accept_encoding.value_or(""));
  const Form& form = gzip ? *file.gzip : file.plain;

  HttpResponse response;
  add_page_headers(response, kPolicy);
  response.headers.emplace_back("ETag", form.tag);
  response.headers.emplace_back("Vary", "Accept-Encoding");
  response.headers.emplace_back("Cache-Control",
                                file.hashed ? "public, max-age=31536000, immutable" : "no-cache");
  if (request.if_none_match && names_tag(*request.if_none_match, form.tag)) {
    response.status = 304;
    return response;
  }
  response.content_type = file.content_type;
  if (gzip) response.headers.emplace_back("Content-Encoding", "gzip");
  response.shared_body = form.bytes;
  return response;
}

}  // namespace earthwork::net
