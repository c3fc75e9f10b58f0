// The files of the page: which folders are taken, and what each file is answered with.
#include "server/net/page_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "tests/net/page_folder.hpp"

namespace earthwork::net {
namespace {

using protocol::Code;

const std::string kIndex = "<!doctype html><title>Earthwork</title>" + std::string(500, ' ');

struct PageFilesTest : testing::Test {
  PageFilesTest() { folder.put_both("index.html", kIndex); }

  [[nodiscard]] PageFiles read() const { return PageFiles::read(folder.path()).value(); }
  void refused(Code code, const std::string& words) const {
    const auto page = PageFiles::read(folder.path());
    ASSERT_FALSE(page) << words;
    EXPECT_EQ(page.error().code, code) << page.error().detail;
    EXPECT_NE(page.error().detail.find(words), std::string::npos) << page.error().detail;
    EXPECT_NE(page.error().detail.find(folder.path().string()), std::string::npos);
  }
  static HttpRequest asking(const char* accept_encoding = nullptr,
                            const std::string& if_none_match = {}) {
    HttpRequest request;
    if (accept_encoding != nullptr) request.accept_encoding = accept_encoding;
    if (!if_none_match.empty()) request.if_none_match = if_none_match;
    return request;
  }
  static std::string header(const HttpResponse& response, const std::string& name) {
    std::string value;
    for (const auto& [key, given] : response.headers)
      if (key == name) value += value.empty() ? given : " TWICE " + given;
    return value;
  }

  PageFolder folder;
};

TEST_F(PageFilesTest, ServesAPageWithAllThatABrowserIsToKnow) {
  const auto answer = read().answer("index.html", asking());
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->bytes(), kIndex);
  EXPECT_EQ(answer->content_type, "text/html; charset=utf-8");
  EXPECT_EQ(header(*answer, "Cache-Control"), "no-cache");
  EXPECT_EQ(header(*answer, "Vary"), "Accept-Encoding");
  EXPECT_EQ(header(*answer, "Content-Encoding"), "");
  EXPECT_EQ(header(*answer, "Content-Security-Policy"),
            "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
            "img-src 'self' data: blob:; connect-src 'self'; manifest-src 'self'; "
            "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  EXPECT_EQ(header(*answer, "X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(header(*answer, "Referrer-Policy"), "no-referrer");
  EXPECT_EQ(header(*answer, "Cross-Origin-Opener-Policy"), "same-origin");
}

TEST_F(PageFilesTest, SendsGzipToWhoTakesIt) {
  folder.put("plain.txt", "no .gz beside it");
  const PageFiles page = read();
  const auto zipped = page.answer("index.html", asking("br, gzip"));
  EXPECT_EQ(header(*zipped, "Content-Encoding"), "gzip");
  EXPECT_EQ(header(*zipped, "Vary"), "Accept-Encoding");
  EXPECT_LT(zipped->bytes().size(), kIndex.size());
  EXPECT_EQ(gunzipped(zipped->bytes(), 10'000), kIndex);
  EXPECT_EQ(zipped->content_type, "text/html; charset=utf-8");

  const auto refused = page.answer("index.html", asking("gzip;q=0"));
  EXPECT_EQ(refused->bytes(), kIndex);
  EXPECT_EQ(header(*refused, "Content-Encoding"), "");
  const auto plain = page.answer("plain.txt", asking("gzip"));
  EXPECT_EQ(plain->bytes(), "no .gz beside it");
  EXPECT_EQ(header(*plain, "Content-Encoding"), "");
}

TEST_F(PageFilesTest, TheTagIsOfTheBytesThatAreSent) {
  const PageFiles page = read();
  const std::string plain = header(*page.answer("index.html", asking()), "ETag");
  const std::string zipped = header(*page.answer("index.html", asking("gzip")), "ETag");
  EXPECT_TRUE(plain.starts_with('"') && plain.ends_with('"')) << plain;
  EXPECT_NE(plain, zipped);
  EXPECT_EQ(header(*read().answer("index.html", asking()), "ETag"), plain);  // after a restart
  folder.put_both("index.html", "another");
  EXPECT_NE(header(*read().answer("index.html", asking()), "ETag"), plain);
}

TEST_F(PageFilesTest, WhoHasTheBytesIsSentNone) {
  const PageFiles page = read();
  const std::string plain = header(*page.answer("index.html", asking()), "ETag");
  const std::string zipped = header(*page.answer("index.html", asking("gzip")), "ETag");
  for (const std::string& tags : {zipped, "\"old\", " + zipped, "W/" + zipped, std::string("*")}) {
    const auto same = page.answer("index.html", asking("gzip", tags));
    EXPECT_EQ(same->status, 304) << tags;
    EXPECT_EQ(same->bytes(), "");
    EXPECT_EQ(same->content_type, "");
    EXPECT_EQ(header(*same, "ETag"), zipped);
    EXPECT_EQ(header(*same, "Cache-Control"), "no-cache");
    EXPECT_EQ(header(*same, "Vary"), "Accept-Encoding");
  }
  EXPECT_EQ(page.answer("index.html", asking("gzip", plain))->status, 200);
  EXPECT_EQ(page.answer("index.html", asking(nullptr, plain))->status, 304);
}

TEST_F(PageFilesTest, AHashInTheNameIsForGood) {
  const std::set<std::string> hashed{"viewer.0a1b2c3d.js", "viewer.0a1b2c3d4e5f6071.wasm",
                                     "a.min.00000000.css"};
  const std::set<std::string> others{
      "viewer.js",   "viewer.0a1b2c3.js", "viewer.0a1b2c3d4e5f60718.js", "viewer.0a1b2c3g.js",
      "0a1b2c3d.js", "viewer.0a1b2c3d",   "viewer-0a1b2c3d.js",          "viewer.0A1B2C3D.js"};
  for (const auto* names : {&hashed, &others})
    for (const std::string& name : *names) folder.put(name, name);
  const PageFiles page = read();
  for (const std::string& name : hashed)
    EXPECT_EQ(header(*page.answer(name, asking()), "Cache-Control"),
              "public, max-age=31536000, immutable")
        << name;
  for (const std::string& name : others)
    EXPECT_EQ(header(*page.answer(name, asking()), "Cache-Control"), "no-cache") << name;
}

TEST_F(PageFilesTest, KnowsWhatItServes) {
  const std::map<std::string, std::string> types{{"a.css", "text/css; charset=utf-8"},
                                                 {"a.js", "text/javascript; charset=utf-8"},
                                                 {"a.mjs", "text/javascript; charset=utf-8"},
                                                 {"a.wasm", "application/wasm"},
                                                 {"a.svg", "image/svg+xml"},
                                                 {"a.png", "image/png"},
                                                 {"a.ico", "image/x-icon"},
                                                 {"a.webmanifest", "application/manifest+json"},
                                                 {"a.txt", "text/plain; charset=utf-8"},
                                                 {"LICENSE", "application/octet-stream"}};
  for (const auto& [name, type] : types) folder.put(name, "x");
  const PageFiles page = read();
  for (const auto& [name, type] : types)
    EXPECT_EQ(page.answer(name, asking())->content_type, type) << name;
}

TEST_F(PageFilesTest, AnswersForNothingElse) {
  folder.put(".secret", "x");
  const PageFiles page = read();
  for (const char* name : {"", ".", "..", "index.html.gz", "Index.html", "index", "index.html/",
                           "/index.html", "../index.html", ".secret", "index.html%00", "etc"})
    EXPECT_FALSE(page.answer(name, asking())) << name;
  EXPECT_FALSE(page.answer(std::string("index.html\0", 11), asking()));
}

TEST_F(PageFilesTest, IsReadOnce) {
  const PageFiles page = read();
  folder.put("index.html", "changed");
  folder.remove("index.html.gz");
  EXPECT_EQ(page.answer("index.html", asking())->bytes(), kIndex);
}

TEST_F(PageFilesTest, WantsAnIndex) {
  folder.remove("index.html.gz"), folder.remove("index.html");
  refused(Code::bad_field, "has no index.html");
  folder.put("index.html.gz", gzipped(kIndex));
  refused(Code::bad_field, "index.html.gz");
}

TEST_F(PageFilesTest, WantsAFolder) {
  const auto missing = PageFiles::read(folder.path() / "nothing");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::storage_failed);
  EXPECT_NE(missing.error().detail.find("nothing"), std::string::npos);
  EXPECT_FALSE(PageFiles::read(folder.path() / "index.html"));
}

TEST_F(PageFilesTest, AnEmptyFileIsOne) {
  folder.put("empty.txt", "");
  EXPECT_EQ(read().answer("empty.txt", asking())->bytes(), "");
}

TEST_F(PageFilesTest, TakesPlainFilesOnly) {
  std::filesystem::create_directory(folder.path() / "sub");
  refused(Code::bad_field, "sub: is not a plain file");
  folder.remove("sub");
  std::filesystem::create_symlink("/etc/passwd", folder.path() / "link.txt");
  refused(Code::bad_field, "link.txt: is not a plain file");
  folder.remove("link.txt");
  std::filesystem::create_symlink("index.html", folder.path() / "inside.html");
  refused(Code::bad_field, "inside.html: is not a plain file");
  folder.remove("inside.html");
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  refused(Code::bad_field, "pipe: is not a plain file");
  folder.remove("pipe");
  folder.put("a b.txt", "x");
  refused(Code::bad_field, "a b.txt: a name has");
  folder.remove("a b.txt");
  EXPECT_TRUE(PageFiles::read(folder.path()));
}

TEST_F(PageFilesTest, AGzipFileIsThatOfItsFile) {
  folder.put("index.html", kIndex + "!");  // built anew, and its .gz was not
  refused(Code::bad_field, "index.html.gz: is not");
  std::string other = kIndex;
  other[0] = 'X';
  folder.put("index.html", other);  // as long as before
  refused(Code::bad_field, "index.html.gz: is not");
  folder.put("index.html", kIndex);
  for (const std::string& bytes :
       {std::string(), std::string("\x1f\x8b\x08"), std::string(40, 'x')}) {
    folder.put("index.html.gz", bytes);
    refused(Code::bad_field, "index.html.gz: is not");
  }
}

TEST_F(PageFilesTest, TakesAHundredAndTwentyEightFilesAndNotOneMore) {
  for (int i = 2; i < 128; ++i) folder.put("f" + std::to_string(i), "x");
  EXPECT_TRUE(PageFiles::read(folder.path()));
  folder.put("one_more", "x");
  refused(Code::too_large, "has more than 128 files");
}

TEST_F(PageFilesTest, TakesSixteenMebibytesAndNotAByteMore) {
  const std::size_t there = kIndex.size() + gzipped(kIndex).size();
  folder.put("large.wasm", std::string((16u << 20) - there, 'x'));
  EXPECT_TRUE(PageFiles::read(folder.path()));
  folder.put("tiny.txt", "x");
  refused(Code::too_large, "tiny.txt: the folder's files have more than 16777216 bytes");
  folder.remove("tiny.txt");
  folder.put("large.wasm", std::string(64u << 20, 'x'));
  refused(Code::too_large, "large.wasm");
}

}  // namespace
}  // namespace earthwork::net
