// Access is refused without the token, from another site, or under another host name.
#include "host/workbench/access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/workbench/served_folder.hpp"

namespace {

using host::workbench::Access;
using testing::HasSubstr;

TEST(Access, ATokenIsLongAndEachIsAnother) {
  EXPECT_EQ(host::workbench::random_token().size(), 32U);
  EXPECT_NE(host::workbench::random_token(), host::workbench::random_token());
}

TEST(Access, KnowsItsOwnNamesOriginsAndCookiesOnly) {
  const Access access("00ff", 8080);
  EXPECT_EQ(access.url(), "http://127.0.0.1:8080/?token=00ff");
  EXPECT_THAT(access.cookie(), testing::AllOf(HasSubstr("HttpOnly"), HasSubstr("SameSite=Strict")));
  for (const char* own : {"127.0.0.1:8080", "localhost:8080"}) EXPECT_TRUE(access.is_own_host(own)) << own;
  for (const char* other : {"", "127.0.0.1", "127.0.0.1:80801", "evil.example:8080", "127.0.0.1:8080.evil.example"})
    EXPECT_FALSE(access.is_own_host(other)) << other;
  EXPECT_TRUE(access.is_own_origin("http://127.0.0.1:8080"));
  EXPECT_TRUE(access.is_own_origin("")) << "no browser";
  for (const char* other : {"null", "https://127.0.0.1:8080", "http://127.0.0.1:8081", "http://evil.example"})
    EXPECT_FALSE(access.is_own_origin(other)) << other;
  for (const char* right : {"axistool-8080=00ff", "a=b; axistool-8080=00ff", "axistool-8080=1; axistool-8080=00ff"})
    EXPECT_TRUE(access.has_cookie(right)) << right;
  for (const char* wrong : {"", ";", "axistool-8080=", "axistool-8080=00fe", "axistool-8080=00ff0",
                            "axistool-8081=00ff", "x=axistool-8080=00ff"})
    EXPECT_FALSE(access.has_cookie(wrong)) << wrong;
}

TEST(Access, ARequestWithoutTokenUnderAnotherNameOrFromAnotherSiteIsRefused) {
  const ServedFolder served;
  const auto status_of = [&](const std::string& path, const httplib::Headers& headers) {
    const auto result = served.client().Get(path, headers);
    return result ? result->status : 0;
  };
  for (const char* path : {"/", "/?token=", "/?token=0123", "/page/main.js", "/api/folder", "/api/jobs", "/nothing"})
    EXPECT_EQ(status_of(path, {}), 403) << path;
  EXPECT_EQ(status_of("/?token=" + served.token, {}), 200);
  EXPECT_EQ(status_of("/api/folder?token=" + served.token, {}), 403) << "the token in the address opens only the page";
  EXPECT_EQ(status_of("/api/folder", served.own), 200);
  httplib::Headers foreign = served.own;
  foreign.emplace("Host", "rebound.example:" + std::to_string(served.server.port()));
  EXPECT_EQ(status_of("/api/folder", foreign), 403);
  EXPECT_EQ(status_of("/?token=" + served.token, {{"Host", "rebound.example"}}), 403);

  const auto posted = [&](const char* origin) {
    httplib::Headers headers = served.own;
    headers.emplace("Origin", origin);
    const auto result = served.client().Post("/api/choice", headers, "{}", "application/json");
    return result ? result->status : 0;
  };
  EXPECT_EQ(posted("http://evil.example"), 403);
  EXPECT_EQ(posted("null"), 403);
  EXPECT_EQ(posted(("http://127.0.0.1:" + std::to_string(served.server.port())).c_str()), 200);
}

TEST(Access, ThePageCarriesItsCookieAndAPolicyWithoutInlineScripts) {
  const ServedFolder served;
  const auto page = served.client().Get("/?token=" + served.token);
  ASSERT_TRUE(page);
  EXPECT_THAT(page->get_header_value("Set-Cookie"), HasSubstr(served.token));
  const std::string policy = page->get_header_value("Content-Security-Policy");
  EXPECT_THAT(policy, testing::AllOf(HasSubstr("default-src 'none'"), HasSubstr("script-src 'self';")));
  EXPECT_EQ(page->get_header_value("Access-Control-Allow-Origin"), "");
  EXPECT_EQ(served.client().Get("/", served.own)->get_header_value("Set-Cookie"), "") << "once is enough";
}

}  // namespace
