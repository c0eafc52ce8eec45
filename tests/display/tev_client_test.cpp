// What the viewer tev is sent, and what becomes of a render whose viewer misbehaves.

#include "kaustik/display/tev_client.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/display/tev_packets.h"
#include "tests/support/fake_tev.h"

namespace kaustik {
namespace {

using test::FakeTev;
using test::ViewerManner;

/// Collects warnings, from whatever thread.
class Warnings {
 public:
  std::function<void(const std::string&)> receiver() {
    return [this](const std::string& text) {
      const std::lock_guard lock(mutex_);
      texts_.push_back(text);
    };
  }
  std::vector<std::string> texts() const {
    const std::lock_guard lock(mutex_);
    return texts_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> texts_;
};

/// Every value is another one.
Image numbered_image(int width, int height, float first = 0) {
  Image image(width, height, {"depth.Z", "B", "G", "R"});
  for (int c = 0; c < 4; ++c)
    for (size_t i = 0; i < image.pixel_count(); ++i)
      image.channel(c)[i] = first + float(i) + 0.25f * float(c);
  return image;
}

void expect_shown(const test::ViewedPicture& picture, const Image& image) {
  ASSERT_EQ(picture.width, image.width());
  ASSERT_EQ(picture.height, image.height());
  ASSERT_EQ(picture.channels.size(), 3u);
  for (const char* name : {"R", "G", "B"}) {
    const auto expected = image.channel(image.find_channel(name));
    const std::vector<float>& shown = picture.channels.at(name);
    ASSERT_EQ(shown.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(shown[i], expected[i]) << name << i;
  }
}

TevAddress address_of(const FakeTev& viewer) { return {"127.0.0.1", viewer.port()}; }

constexpr double long_s = 60;

double seconds_of(const std::function<void()>& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The bytes of a packet, from the description of the protocol.
TEST(TevPackets, AreWhatTheViewerReads) {
  const tev::Packet close = tev::close_image("a.exr");
  EXPECT_EQ(close, (tev::Packet{11, 0, 0, 0, 2, 'a', '.', 'e', 'x', 'r', 0}));
  const tev::Packet create = tev::create_image("x", true, 258, 3, {"R", "G"});
  EXPECT_EQ(create, (tev::Packet{24, 0, 0, 0, 4, 1, 'x', 0, 2,   1, 0,   0,
                                 3,  0, 0, 0, 2, 0, 0,   0, 'R', 0, 'G', 0}));
  const std::vector<float> values = {1, -2};
  const tev::Packet update = tev::update_image("x", {"R"}, {-1, 7, 2, 1}, values);
  EXPECT_EQ(update,
            (tev::Packet{54, 0, 0, 0, 6, 0, 'x', 0, 1, 0, 0, 0, 'R',  0,    255, 255, 255, 255,
                         7,  0, 0, 0, 2, 0, 0,   0, 1, 0, 0, 0, 0,    0,    0,   0,   0,   0,
                         0,  0, 1, 0, 0, 0, 0,   0, 0, 0, 0, 0, 0x80, 0x3F, 0,   0,   0,   0xC0}));
  EXPECT_THROW(tev::update_image("x", {"R", "G"}, {0, 0, 2, 1}, values), std::logic_error);
}

TEST(TevClient, ShowsPictures) {
  Warnings warnings;
  FakeTev viewer;
  // More than a packet holds, and rows that do not fill packets.
  const Image first = numbered_image(517, 401), second = numbered_image(517, 401, 1000);
  {
    TevClient client(address_of(viewer), "picture.exr", warnings.receiver());
    client.show(first);
    client.finish(long_s);
    EXPECT_TRUE(client.is_idle());
    client.show(second);
    client.finish(long_s);
  }
  // What was sent last may still be on its way.
  for (int i = 0; i < 2000 && viewer.pictures()["picture.exr"].channels["R"].back() !=
                                  second.channel(3)[second.pixel_count() - 1];
       ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(viewer.complaint(), "");
  const auto pictures = viewer.pictures();
  ASSERT_EQ(pictures.size(), 1u);
  expect_shown(pictures.at("picture.exr"), second);
  const std::vector<int> types = viewer.types();
  EXPECT_EQ(std::count(types.begin(), types.end(), 4), 1) << "it is created once";
  EXPECT_GT(types.size(), 6u);
  EXPECT_EQ(warnings.texts(), std::vector<std::string>());
}

TEST(TevClient, TellsOnceOfAViewerThatIsNotThere) {
  uint16_t free_port = 0;
  { free_port = FakeTev().port(); }
  Warnings warnings;
  TevClient client({"127.0.0.1", free_port}, "a", warnings.receiver());
  client.finish(long_s);
  for (int i = 0; i < 3; ++i) client.show(numbered_image(4, 4));
  client.finish(long_s);
  EXPECT_TRUE(client.is_gone());
  ASSERT_EQ(warnings.texts().size(), 1u);
  const std::string text = warnings.texts()[0];
  EXPECT_NE(text.find("127.0.0.1:" + std::to_string(free_port)), std::string::npos) << text;
  EXPECT_NE(text.find("the render goes on without it"), std::string::npos) << text;
}

TEST(TevClient, TellsOfAHostThatIsNone) {
  Warnings warnings;
  TevClient client({"a host.invalid", 1}, "a", warnings.receiver());
  client.show(numbered_image(4, 4));
  client.finish(long_s);
  EXPECT_EQ(warnings.texts().size(), 1u);
}

TEST(TevClient, TellsOnceOfAViewerThatCloses) {
  Warnings warnings;
  FakeTev viewer(ViewerManner::closes_early);
  TevClient client(address_of(viewer), "a", warnings.receiver());
  for (int i = 0; i < 1000 && !client.is_gone(); ++i) {
    client.show(numbered_image(64, 64));
    client.finish(0.05);
  }
  EXPECT_TRUE(client.is_gone());
  ASSERT_EQ(warnings.texts().size(), 1u);
  EXPECT_NE(warnings.texts()[0].find("closed the connection"), std::string::npos)
      << warnings.texts()[0];
}

// More than the system's buffers hold stays unread.
TEST(TevClient, WaitsForNobody) {
  const Image large = numbered_image(1400, 1400);
  Warnings warnings;
  FakeTev viewer(ViewerManner::never_reads);
  {
    TevClient client(address_of(viewer), "a", warnings.receiver(), {5, 0.3});
    // Copies of the image take a while, too.
    const double copied = seconds_of([&] { const Image copy = large; });
    EXPECT_LT(seconds_of([&] { client.show(large); }), 2 + 10 * copied);
    client.finish(long_s);
    EXPECT_TRUE(client.is_gone());
    ASSERT_EQ(warnings.texts().size(), 1u);
    EXPECT_NE(warnings.texts()[0].find("stopped reading"), std::string::npos)
        << warnings.texts()[0];
  }
  // One that would be waited for much longer is left at once, without a word.
  Warnings others;
  FakeTev silent(ViewerManner::never_reads);
  const double left = seconds_of([&] {
    TevClient client(address_of(silent), "a", others.receiver(), {5, 1000});
    client.show(large);
    while (!silent.is_connected()) std::this_thread::yield();
    client.finish(0.1);
    EXPECT_FALSE(client.is_idle());
  });
  EXPECT_LT(left, 20);
  EXPECT_EQ(others.texts(), std::vector<std::string>());
}

TEST(TevAddress, IsReadAsPeopleWriteIt) {
  const auto told = [](const std::string& text) { return TevAddress::parse(text).text(); };
  EXPECT_EQ(told("localhost"), "localhost:14158");
  EXPECT_EQ(told("render.example.org:99"), "render.example.org:99");
  EXPECT_EQ(told(":7"), "localhost:7");
  EXPECT_EQ(told("[::1]"), "[::1]:14158");
  EXPECT_EQ(told("[::1]:65535"), "[::1]:65535");
  for (const char* wrong : {"", "a:", "a:0", "a:65536", "a:12x", "a:-1", "[::1", "[]:5", "[::1]5",
                            "a b", "http://a:5", "a:1:2"}) {
    SCOPED_TRACE(wrong);
    try {
      TevAddress::parse(wrong);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_FALSE(error.problems().front().remedy.empty());
    }
  }
}

}  // namespace
}  // namespace kaustik
