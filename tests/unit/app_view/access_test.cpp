// Which requests are accepted, and what is taken from them.
#include "app/view/access.h"

#include <gtest/gtest.h>
#include <set>

#include "app/shown/file_name.h"
#include "app/view/events.h"
#include "app/view/page.h"

namespace kerf::app::view {
namespace {

TEST(Access, TokensDiffer) {
  std::set<std::string> seen;
  for (int k = 0; k < 100; ++k) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 24u);
    EXPECT_EQ(download_name(token), token.front() == '.' ? "_" + token : token);
    EXPECT_TRUE(seen.insert(token).second);
  }
}

TEST(Access, NeedsTheTokenAndTheOwnHost) {
  const std::string token = "abcdefghijklmnop";
  EXPECT_EQ(refusal({"127.0.0.1:8000", "", token}, 8000, token), "");
  EXPECT_EQ(refusal({"localhost:8000", "http://localhost:8000", token}, 8000, token), "");
  for (const char* wrong :
       {"", "a", "abcdefghijklmno", "abcdefghijklmnoq", "abcdefghijklmnopq", "ABCDEFGHIJKLMNOP"})
    EXPECT_NE(refusal({"127.0.0.1:8000", "", wrong}, 8000, token), "") << wrong;
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:8001", "example.com:8000",
                           "127.0.0.1:8000.example.com", "127.0.0.1:80000", "[::1]:8000"})
    EXPECT_NE(refusal({host, "", token}, 8000, token), "") << host;
  for (const char* origin : {"null", "http://example.com", "https://127.0.0.1:8000", "http://127.0.0.1:8001",
                             "http://127.0.0.1:8000.example.com", "http://"})
    EXPECT_NE(refusal({"127.0.0.1:8000", origin, token}, 8000, token), "") << origin;
  EXPECT_NE(refusal({"127.0.0.1:8000", "", ""}, 8000, ""), "");  // without a token nothing is answered
}

TEST(Access, ReadsWholeNumbersOnly) {
  EXPECT_EQ(parse_number("0"), 0u);
  EXPECT_EQ(parse_number("4294967295"), 4294967295u);
  for (const char* text : {"", "4294967296", "99999999999", "-1", "+1", " 1", "1 ", "1e3", "0x10", "1.5"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Access, NamesOfDownloadsHaveNoSpecialCharacters) {
  EXPECT_EQ(download_name("part-2_b.nc"), "part-2_b.nc");
  EXPECT_EQ(download_name("a\"b\r\nSet-Cookie: x/../é"), "a_b__Set-Cookie__x_..___");
  EXPECT_EQ(download_name(""), "_");
  EXPECT_EQ(download_name("..x"), "_..x");
  EXPECT_EQ(download_name(std::string(500, 'x')).size(), 100u);
}

TEST(Events, ReachEveryPageOnceAndKeepOnlyTheNewestProgress) {
  Events events;
  EXPECT_EQ(events.newest(), 0u);
  events.publish("model", R"({"revision":1})");
  events.publish("progress", R"({"fraction":0.1})");
  events.publish("progress", "{\"fraction\":\n0.2}");
  auto batch = events.wait(0, std::chrono::milliseconds(0));
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->text,
            "event: model\ndata: {\"revision\":1}\n\nevent: progress\ndata: {\"fraction\": 0.2}\n\n");
  EXPECT_EQ(events.wait(batch->newest, std::chrono::milliseconds(1))->text, "");
  for (int k = 0; k < 200; ++k) events.publish("model", "{}");
  EXPECT_TRUE(events.wait(batch->newest, std::chrono::milliseconds(0))->has_missed);
  events.close();
  EXPECT_FALSE(events.wait(0, std::chrono::milliseconds(1000)));
}

TEST(Page, HasANonceOfItsOwnForEachAnswer) {
  const Page a = served_page(), b = served_page();
  EXPECT_EQ(a.html.find("KERF_"), std::string::npos);
  EXPECT_NE(a.policy, b.policy);
  const std::size_t at = a.policy.find("'nonce-") + 7;
  const std::string nonce = a.policy.substr(at, a.policy.find('\'', at) - at);
  EXPECT_NE(a.html.find("nonce=\"" + nonce + "\""), std::string::npos);
  EXPECT_EQ(b.html.find(nonce), std::string::npos);
}

TEST(Access, OriginsOfPagesHaveNoPathAndEndNoHeader) {
  for (const char* text :
       {"https://shop.example", "http://localhost:3000", "http://127.0.0.1", "https://a-b.c"})
    EXPECT_TRUE(is_page_origin(text)) << text;
  for (const char* text : {"",
                           "*",
                           "https://",
                           "https://*.example",
                           "https://shop.example/",
                           "https://shop.example/a",
                           "shop.example",
                           "ftp://shop.example",
                           "https://Shop.example",
                           "https://a b",
                           "https://a;script-src *",
                           "https://a\" x=\"",
                           "https://a\r\nX: y",
                           "http://a:",
                           "http://a:123456",
                           "http://a:1:2",
                           "http://u@a",
                           "http://-a",
                           "null",
                           "'self'",
                           "https://.a"})
    EXPECT_FALSE(is_page_origin(text)) << text;
}

TEST(Page, IsFramedByNoPageButThoseThatAreAllowed) {
  EXPECT_NE(served_page().policy.find("frame-ancestors 'none'"), std::string::npos);
  const Page framed = served_page({"https://shop.example", "http://localhost:3000"});
  EXPECT_TRUE(framed.policy.ends_with("frame-ancestors https://shop.example http://localhost:3000"));
  EXPECT_EQ(framed.html.find("KERF_"), std::string::npos);
}

TEST(Page, PacksDataAsBase64OfZlib) {
  EXPECT_EQ(packed(""), "eJwDAAAAAAE=");  // python: base64.b64encode(zlib.compress(b""))
  EXPECT_EQ(packed("kerf"), "eJzLTi1KAwAEKQGp");
}

}  // namespace
}  // namespace kerf::app::view
