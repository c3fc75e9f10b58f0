// The page over real sockets, and the WebSocket that a browser opens from it.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "server/net/server.hpp"
#include "tests/net/page_folder.hpp"
#include "tests/net/raw_client.hpp"

namespace earthwork::net {
namespace {

const std::string kIndex = "<!doctype html><title>Earthwork</title>" + std::string(500, ' ');
const std::string kScript = "export const answer = 42;\n" + std::string(2'000'000, ' ');

struct PageTest : testing::Test {
  PageTest() {
    PageFolder folder;  // gone before the first request
    folder.put_both("index.html", kIndex);
    folder.put_both("viewer.0a1b2c3d.js", kScript);
    page = std::make_shared<const PageFiles>(PageFiles::read(folder.path()).value());
    server = start("127.0.0.1");
  }
  [[nodiscard]] std::unique_ptr<Server> start(const std::string& host,
                                              std::vector<std::string> allowed = {}) const {
    return Server::start({.listen = {host, 0},
                          .allowed_hosts = std::move(allowed),
                          .limits = {},
                          .page = page})
        .value();
  }
  [[nodiscard]] std::uint16_t port() const { return server->address().port; }
  HttpAnswer ask(const std::string& line, const std::string& headers = {}) {
    return http(port(), line + " HTTP/1.1\r\nHost: " + server->address().text() + "\r\n" + headers +
                            "Connection: close\r\n\r\n");
  }

  std::shared_ptr<const PageFiles> page;
  std::unique_ptr<Server> server;
};

TEST_F(PageTest, IsWhatABrowserIsShown) {
  for (const char* target : {"/", "/?map=demo", "/?", "/index.html"}) {
    const HttpAnswer answer = ask(std::string("GET ") + target);
    EXPECT_EQ(answer.status, 200) << target;
    EXPECT_EQ(answer.body, kIndex) << target;
    EXPECT_EQ(answer.headers.at("content-type"), "text/html; charset=utf-8");
    EXPECT_EQ(answer.headers.at("content-length"), std::to_string(kIndex.size()));
    EXPECT_EQ(answer.headers.at("cache-control"), "no-cache");
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
  }
}

TEST_F(PageTest, SendsALargeFileWholeAndCompressedToWhoTakesIt) {
  const HttpAnswer plain = ask("GET /viewer.0a1b2c3d.js");
  EXPECT_EQ(plain.status, 200);
  EXPECT_TRUE(plain.body == kScript);
  EXPECT_EQ(plain.headers.at("cache-control"), "public, max-age=31536000, immutable");
  const HttpAnswer zipped =
      ask("GET /viewer.0a1b2c3d.js", "Accept-Encoding: gzip, deflate, br\r\n");
  EXPECT_EQ(zipped.headers.at("content-encoding"), "gzip");
  EXPECT_EQ(zipped.headers.at("vary"), "Accept-Encoding");
  EXPECT_EQ(zipped.headers.at("content-length"), std::to_string(zipped.body.size()));
  EXPECT_TRUE(gunzipped(zipped.body, kScript.size()) == kScript);
  EXPECT_EQ(ask("GET /viewer.0a1b2c3d.js", "Accept-Encoding: gzip\r\nAccept-Encoding: gzip;q=0\r\n")
                .headers.count("content-encoding"),
            0u);
}

TEST_F(PageTest, HeadAndA304HaveNoBody) {
  const HttpAnswer head = ask("HEAD /");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.headers.at("content-length"), std::to_string(kIndex.size()));
  EXPECT_EQ(head.body, "");
  const HttpAnswer same = ask("GET /", "If-None-Match: " + head.headers.at("etag") + "\r\n");
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.body, "");
  EXPECT_EQ(same.headers.at("etag"), head.headers.at("etag"));
  // It would tell a cache that what it has is of no bytes.
  EXPECT_EQ(same.headers.count("content-length"), 0u);
  EXPECT_EQ(ask("GET /", "If-None-Match: \"another\"\r\n").status, 200);
}

TEST_F(PageTest, A304LeavesTheConnectionOpen) {
  TcpClient client(port());
  const std::string host = " HTTP/1.1\r\nHost: " + server->address().text() + "\r\n";
  ASSERT_TRUE(client.send("GET /" + host + "If-None-Match: *\r\n\r\nGET /" + host +
                          "Connection: close\r\n\r\n"));
  bool closed = false;
  const std::string all = client.read_to_end(closed);
  EXPECT_TRUE(closed);
  EXPECT_TRUE(all.starts_with("HTTP/1.1 304 "));
  EXPECT_NE(all.find("\r\n\r\nHTTP/1.1 200 "), std::string::npos);
  EXPECT_TRUE(all.ends_with(kIndex));
}

TEST_F(PageTest, ServesManyFilesOnOneConnection) {
  TcpClient client(port());
  const std::string host = " HTTP/1.1\r\nHost: " + server->address().text() + "\r\n";
  ASSERT_TRUE(client.send("GET /" + host + "\r\nHEAD /viewer.0a1b2c3d.js" + host +
                          "\r\nGET /viewer.0a1b2c3d.js" + host + "Connection: close\r\n\r\n"));
  bool closed = false;
  const std::string all = client.read_to_end(closed);
  EXPECT_TRUE(closed);
  EXPECT_NE(all.find(kIndex + "HTTP/1.1 200"), std::string::npos);
  EXPECT_TRUE(all.ends_with(kScript));
}

TEST_F(PageTest, NothingElseIsReached) {
  for (const char* target : {"/nothing.js", "/index.html.gz", "/viewer.0a1b2c3d.js.gz",
                             "/../etc/passwd", "/..", "/%2e%2e/etc/passwd", "/..%2fetc%2fpasswd",
                             "/index%2ehtml", "//index.html", "/./index.html", "/etc/passwd",
                             "/page/index.html", "/index.html/", "/\\..\\etc", "/INDEX.HTML"})
    EXPECT_EQ(ask(std::string("GET ") + target).status, 404) << target;
  EXPECT_EQ(ask("GET /healthz").body, "ok\n");
  EXPECT_EQ(ask("GET /api/maps").status, 200);
  EXPECT_EQ(ask("POST /").status, 405);
  EXPECT_EQ(ask("DELETE /index.html").headers.at("allow"), "GET, HEAD");
}

TEST_F(PageTest, IsForTheServersOwnNamesOnly) {
  const auto get = [&](const std::string& headers) {
    return http(port(), "GET / HTTP/1.1\r\n" + headers + "Connection: close\r\n\r\n").status;
  };
  const std::string ending = ":" + std::to_string(port()) + "\r\n";
  EXPECT_EQ(get("Host: localhost" + ending), 200);
  EXPECT_EQ(get("Host: LOCALHOST" + ending), 200);
  EXPECT_EQ(get("Host: evil.example" + ending), 403);
  EXPECT_EQ(get("Host: localhost" + ending + "Origin: http://evil.example\r\n"), 403);
}

/// Whether a page that was opened at `host` may open the WebSocket, and is answered over it.
bool connects(std::uint16_t port, const std::string& host, const std::string& origin) {
  SocketClient client(port, {.host = host, .origin = origin});
  if (client.status() != 101) return false;
  client.text(R"({"type":"hello","protocol":[1,1],"name":"ann","id":1})");
  return client.receive_text().starts_with(R"({"type":"welcome")");
}

TEST_F(PageTest, AWebSocketIsOpenedFromIt) {
  for (const std::string& name : {std::string("localhost"), std::string("127.0.0.1")}) {
    const std::string host = name + ":" + std::to_string(port());
    EXPECT_TRUE(connects(port(), host, "http://" + host)) << host;
    EXPECT_FALSE(connects(port(), host, "http://evil.example"));
    EXPECT_FALSE(connects(port(), host, "https://" + host));
    EXPECT_FALSE(connects(port(), host, "null"));
  }
  EXPECT_FALSE(connects(port(), "localhost", "http://localhost"));  // another port's page
}

TEST_F(PageTest, AWebSocketIsOpenedFromItUnderTheNamesThatWereAllowed) {
  server = start("0.0.0.0", {"maps.example", "other.example:81"});
  const std::string at = ":" + std::to_string(port());
  for (const std::string& host :
       {"maps.example" + at, std::string("maps.example"), "MAPS.example" + at,
        std::string("other.example:81"), "127.0.0.1" + at, "localhost" + at}) {
    EXPECT_TRUE(connects(port(), host, "http://" + host)) << host;
    EXPECT_EQ(
        http(port(), "GET / HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n").body,
        kIndex);
  }
  for (const std::string& host : {"other.example" + at, std::string("other.example"),
                                  "sub.maps.example" + at, "192.0.2.1" + at})
    EXPECT_FALSE(connects(port(), host, "http://" + host)) << host;
  EXPECT_FALSE(connects(port(), "maps.example" + at, "http://evil.example" + at));
}

}  // namespace
}  // namespace earthwork::net
