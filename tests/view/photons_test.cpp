// Photons that are sent to pages.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "kaustik/integrator/override_integrator.h"
#include "kaustik/scene/overrides.h"
#include "tests/view/shown_scene.h"

namespace kaustik::test {
namespace {

using nlohmann::json;

struct SentPhoton {
  float position[3], flux[3];
  uint8_t kind, level;
  uint16_t lamp;
};
static_assert(sizeof(SentPhoton) == 28);

struct SentPhotons {
  json head;
  std::vector<SentPhoton> photons;
};

SentPhotons photons_of(const ClientResponse& response) {
  SentPhotons sent;
  EXPECT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.header("content-type"), "application/octet-stream");
  uint32_t length = 0;
  if (response.body.size() < 4) return sent;
  std::memcpy(&length, response.body.data(), 4);
  EXPECT_EQ(length % 4, 0u);
  sent.head = json::parse(response.body.substr(4, length), nullptr, false);
  const size_t bytes = response.body.size() - 4 - length;
  EXPECT_EQ(bytes, sent.head["count"].get<size_t>() * sizeof(SentPhoton));
  sent.photons.resize(bytes / sizeof(SentPhoton));
  std::memcpy(sent.photons.data(), response.body.data() + 4 + length, bytes);
  return sent;
}

/// With few photons, which are soon traced.
Description scene_of_few_photons() {
  Description description = shown_scene();
  override_integrator(description, "photonmap");
  for (const char* setting : {"integrator.gather=false", "integrator.global_photons=20000",
                              "integrator.caustic_photons=5000"})
    override_property(description, setting_from(setting, "test"));
  return description;
}

TEST(ViewPhotons, AreSomeOfThoseOfTheScene) {
  ShownScene shown(shown_settings(), scene_of_few_photons());
  ASSERT_TRUE(shown.wait_until_done());
  const SentPhotons many = photons_of(shown.ask("GET", "/photons?max=3000"));
  EXPECT_EQ(many.head["kinds"], json({"global", "caustic", "volume"}));
  EXPECT_EQ(many.head["lamps"].size(), shown.server().engine().scene()->lights().size());
  ASSERT_EQ(many.photons.size(), 3000u);
  EXPECT_GT(many.head["total"].get<uint64_t>(), 3000u);
  double flux = 0;
  for (const SentPhoton& photon : many.photons) {
    ASSERT_LE(photon.kind, 1);  // no media
    ASSERT_GE(photon.level, 1);
    ASSERT_LT(photon.lamp, many.head["lamps"].size());
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(std::isfinite(photon.position[i]) && std::abs(photon.position[i]) < 100);
      ASSERT_TRUE(photon.flux[i] >= 0);
      flux += double(photon.flux[i]);
    }
  }
  EXPECT_GT(flux, 0);
  // The same ones each time, and fewer are the first of them.
  const SentPhotons few = photons_of(shown.ask("GET", "/photons?max=10"));
  ASSERT_EQ(few.photons.size(), 10u);
  EXPECT_EQ(few.head["key"], many.head["key"]);
  EXPECT_EQ(std::memcmp(few.photons.data(), many.photons.data(), 10 * sizeof(SentPhoton)), 0);
}

TEST(ViewPhotons, AreSentAgainOnlyIfTheyAreOthers) {
  ShownScene shown(shown_settings(), scene_of_few_photons());
  ASSERT_TRUE(shown.wait_until_done());
  const std::string key = photons_of(shown.ask("GET", "/photons?max=5")).head["key"];
  const std::string known = "/photons?max=5&known=" + key;
  EXPECT_EQ(shown.ask("GET", known).status, 204);
  // A camera's move leaves them.
  json camera = shown.get("/state")["camera"];
  camera["origin"][0] = camera["origin"][0].get<double>() + 0.3;
  EXPECT_EQ(shown.command({{"camera", camera}}).status, 200);
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_EQ(shown.ask("GET", known).status, 204);
  // What light meets does not.
  EXPECT_EQ(shown.command({{"set", {{"ball.radius", 0.2}}}}).status, 200);
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_NE(photons_of(shown.ask("GET", known)).head["key"], key);
}

TEST(ViewPhotons, BadRequestsHarmNothing) {
  ShownScene shown(shown_settings(), scene_of_few_photons());
  ASSERT_TRUE(shown.wait_until_done());
  for (const char* query :
       {"?max=0", "?max=-1", "?max=100001", "?max=x", "?max=1&max=1", "?most=1", "?known=x",
        "?known=0x12", "?known=11111111111111111", "?known=-1", "?known=%20"}) {
    const ClientResponse response = shown.ask("GET", std::string("/photons") + query);
    EXPECT_EQ(response.status, 400) << query << ": " << response.body;
    EXPECT_TRUE(json::parse(response.body)["error"].is_string()) << query;
  }
  EXPECT_EQ(shown.ask("POST", "/photons", "{}").status, 405);
  EXPECT_EQ(shown.ask_apart("GET /photons HTTP/1.1\r\nHost: " + shown.host() + "\r\n\r\n").status,
            403);
  EXPECT_EQ(photons_of(shown.ask("GET", "/photons?max=1")).photons.size(), 1u);
}

TEST(ViewPhotons, FramesTellHowPointsAreProjected) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const ClientResponse frame = shown.ask("GET", "/frame?after=0&width=10");
  ASSERT_EQ(frame.status, 200);
  std::istringstream text(frame.header("x-projection"));
  std::vector<double> m;
  for (double number; text >> number;) m.push_back(number);
  ASSERT_EQ(m.size(), 12u);
  // What the camera looks at is in the middle of the whole picture.
  const double target[4] = {0, 0, 0.5, 1};
  double row[3] = {};
  for (size_t i = 0; i < 12; ++i) row[i / 4] += m[i] * target[i % 4];
  EXPECT_GT(row[2], 0);
  EXPECT_NEAR(row[0] / row[2], shown_width / 2.0, 0.01);
  EXPECT_NEAR(row[1] / row[2], shown_height / 2.0, 0.01);
}

}  // namespace
}  // namespace kaustik::test
