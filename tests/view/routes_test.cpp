// What may be asked for, and what comes back.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <thread>

#include "kaustik/image/image_io.h"
#include "kaustik/image/photometry.h"
#include "kaustik/live/engine.h"
#include "kaustik/render/job.h"
#include "kaustik/view/frames.h"
#include "tests/support/same_bits.h"
#include "tests/view/shown_scene.h"

namespace kaustik::test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

/// The picture that the server ends with.
Image finished_picture_of_scene() {
  JobSettings settings;
  settings.session = shown_session();
  Job job(shown_scene(), std::move(settings));
  job.run();
  return job.image();
}

TEST(ViewRoutes, ThePageNeedsNoSession) {
  ShownScene shown;
  const ClientResponse page =
      shown.ask_apart("GET / HTTP/1.1\r\nHost: " + shown.host() + "\r\n\r\n");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.header("content-type"), "text/html; charset=utf-8");
  EXPECT_NE(page.body.find("<!doctype html>"), std::string::npos);
  EXPECT_EQ(page.header("x-content-type-options"), "nosniff");
  EXPECT_NE(page.header("content-security-policy").find("default-src 'self'"), std::string::npos);
  EXPECT_NE(page.header("content-security-policy").find("frame-ancestors 'none'"),
            std::string::npos);
  EXPECT_EQ(page.header("cache-control"), "no-store");
  EXPECT_TRUE(page.header("access-control-allow-origin").empty());
}

TEST(ViewRoutes, StateTellsWhatTheProtocolSays) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  shown.client().close();
  json state = json::parse(shown.ask_apart(shown.request("GET", "/state")).body);
  EXPECT_EQ(state["program"], "0.1.0");
  EXPECT_EQ(state["scene"], "test");
  EXPECT_EQ(state["state"], "finished");
  EXPECT_EQ(state["width"], shown_width);
  EXPECT_EQ(state["height"], shown_height);
  EXPECT_EQ(state["passes"], 4);
  EXPECT_EQ(state["revision"], 1);
  EXPECT_TRUE(state["failure"].is_null());
  EXPECT_TRUE(state["refusal"].is_null());
  EXPECT_TRUE(state["error"].is_number());
  EXPECT_EQ(state["integrator"], "path");
  EXPECT_EQ(state["unit"], "W/(sr·m²)");
  EXPECT_EQ(state["is_moving"], false);
  EXPECT_NEAR(state["camera"]["origin"][1].get<double>(), -4, 1e-6);
  EXPECT_NEAR(state["camera"]["fov"].get<double>(), 45, 1e-6);
  // The horizon is level, so that up is an axis of the world.
  EXPECT_EQ(state["camera"]["up"], json({0.0, 0.0, 1.0}));
  // The target is what is seen in the middle: the glass ball's front, some 3.5 m away.
  const auto& target = state["camera"]["target"];
  EXPECT_NEAR(target[0].get<double>(), 0, 1e-5);
  EXPECT_LT(target[1].get<double>(), 0);
  EXPECT_GT(target[1].get<double>(), -1);
}

TEST(ViewRoutes, PixelsAreThoseOfTheFilm) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const Image image = finished_picture_of_scene();
  int known = 0;
  for (int y = 0; y < shown_height; y += 3)
    for (int x = 0; x < shown_width; x += 5) {
      const json pixel = shown.get("/pixel?x=" + std::to_string(x) + "&y=" + std::to_string(y));
      const auto at = [&](const char* channel) {
        return image.at(x, y, image.find_channel(channel));
      };
      EXPECT_EQ(pixel["passes"], 4);
      EXPECT_EQ(pixel["value"][0].get<float>(), at("R"));
      EXPECT_EQ(pixel["value"][2].get<float>(), at("B"));
      EXPECT_EQ(pixel["layers"]["direct"][1].get<float>(), at("direct.G"));
      EXPECT_EQ(pixel["layers"]["N"][2].get<float>(), at("N.Z"));
      EXPECT_EQ(pixel["layers"]["depth"][0].get<float>(), at("depth.Z"));
      const double luminance = pixel["luminance"];
      ASSERT_TRUE(pixel["interval"].is_array());
      EXPECT_LE(pixel["interval"][0].get<double>(), luminance + 1e-6);
      EXPECT_GE(pixel["interval"][1].get<double>(), luminance - 1e-6);
      // Of three equal channels the luminance has their error.
      if (const double error = pixel["standard_error"]; error > 0) {
        EXPECT_NEAR(error, double(at("error.G")), 1e-3 * error);
        ++known;
      }
    }
  EXPECT_GT(known, 10);
}

TEST(ViewRoutes, RegionsHaveTheMeanOfTheirPixels) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const Image image = finished_picture_of_scene();
  double sum = 0;
  for (int y = 2; y < 8; ++y)
    for (int x = 5; x < 15; ++x)
      sum += double(photopic(rgb_view(image)[size_t(y * shown_width + x)]));
  const json region = shown.get("/region?x=5&y=2&width=10&height=6");
  EXPECT_EQ(region["pixels"], 60);
  EXPECT_NEAR(region["mean"].get<double>(), sum / 60, 1e-5 * sum / 60);
  EXPECT_GT(region["standard_error"].get<double>(), 0);
  EXPECT_LT(region["interval"][0].get<double>(), region["mean"].get<double>());
}

TEST(ViewRoutes, FramesAreThePicture) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const Image image = finished_picture_of_scene();
  const ClientResponse frame = shown.ask("GET", "/frame?after=0&format=f32");
  ASSERT_EQ(frame.status, 200);
  EXPECT_EQ(frame.header("x-width"), std::to_string(shown_width));
  EXPECT_EQ(frame.header("x-height"), std::to_string(shown_height));
  EXPECT_EQ(frame.header("x-kind"), "passes");
  EXPECT_EQ(frame.header("x-passes"), "4");
  EXPECT_EQ(frame.header("x-moving"), "0");
  EXPECT_EQ(frame.header("x-scale"), "1");
  EXPECT_EQ(frame.header("x-revision"), "1");
  ASSERT_EQ(frame.body.size(), size_t(shown_width * shown_height * 12));
  std::vector<float> values(frame.body.size() / 4);
  std::memcpy(values.data(), frame.body.data(), frame.body.size());
  const RgbView view = rgb_view(image);
  for (size_t i = 0; i < image.pixel_count(); ++i) ASSERT_EQ(values[3 * i + 1], view[i].y) << i;

  const ClientResponse small = shown.ask("GET", "/frame?after=0&width=13");
  EXPECT_EQ(small.header("x-width"), "12");
  EXPECT_EQ(small.body.size(), size_t(12 * 9 * 4));
  // Layers are asked of the film.
  const ClientResponse direct = shown.ask("GET", "/frame?after=0&format=f32&layer=direct");
  ASSERT_EQ(direct.body.size(), frame.body.size());
  std::memcpy(values.data(), direct.body.data(), direct.body.size());
  EXPECT_EQ(values[3 * 100], rgb_view(image, "direct")[100].x);
  EXPECT_EQ(shown.ask("GET", "/frame?layer=error").status, 200);
  EXPECT_EQ(shown.ask("GET", "/frame?layer=depth").status, 200);
  EXPECT_EQ(shown.ask("GET", "/frame?layer=nothing").status, 404);
}

TEST(ViewRoutes, PollsWaitForTheNextFrame) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const uint64_t last = shown.server().engine().snapshot()->number;
  HttpClient waiting(shown.port());
  waiting.send(shown.request("GET", "/frame?after=" + std::to_string(last)));
  EXPECT_EQ(waiting.receive(300ms), "");
  ASSERT_EQ(shown.command({{"do", "reset"}}).status, 200);
  const ClientResponse frame = waiting.response();
  EXPECT_EQ(frame.status, 200);
  EXPECT_GT(std::stoull(frame.header("x-number")), last);
  EXPECT_EQ(frame.header("x-revision"), "2");
  // Pages that knew an earlier server need not wait for numbers as large.
  EXPECT_EQ(shown.ask("GET", "/frame?after=1000000").status, 200);
}

TEST(ViewRoutes, EventsTellWhatChanges) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  HttpClient listener(shown.port());
  listener.send(shown.request("GET", "/events"));
  const std::string head = listener.until("\r\n\r\n");
  EXPECT_NE(head.find("text/event-stream"), std::string::npos);
  const std::string first = listener.until("\n\n");
  ASSERT_EQ(first.rfind("event: state\ndata: {", 0), 0u) << first;
  EXPECT_EQ(json::parse(first.substr(first.find('{')))["scene"], "test");
  const std::string history = listener.until("\n\n");
  ASSERT_EQ(history.rfind("event: error_history\ndata: {", 0), 0u) << history;
  ASSERT_EQ(shown.command({{"do", "reset"}}).status, 200);
  EXPECT_NE(listener.until("\"revision\":2"), "");
}

// However short the moment is in which there is a new error, those who listen are told of it.
TEST(ViewRoutes, ErrorsAreToldToThoseWhoListen) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  HttpClient listener(shown.port());
  listener.send(shown.request("GET", "/events"));
  const auto next_history = [&] {
    if (listener.until("event: error_history\ndata: ", std::chrono::seconds(20)).empty())
      return json();
    return json::parse(listener.until("\n\n"), nullptr, false);
  };
  ASSERT_TRUE(next_history().is_object());
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(shown.command({{"do", "reset"}}).status, 200);
    ASSERT_TRUE(shown.wait_until_done());
    json history = next_history();
    while (history.is_object() && history["error"].empty()) history = next_history();
    ASSERT_TRUE(history.is_object()) << "nothing came after reset " << i;
    EXPECT_GT(history["error"].back(), 0);
  }
}

TEST(ViewRoutes, CamerasMove) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const json camera = {
      {"origin", {0.5, -4, 2}}, {"target", {0, 0, 0.5}}, {"up", {0, 0, 1}}, {"fov", 40}};
  const ClientResponse response = shown.command({{"camera", camera}});
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(json::parse(response.body)["revision"], 2);
  ASSERT_TRUE(shown.wait_until_done());
  const json told = shown.get("/state")["camera"];
  EXPECT_NEAR(told["origin"][0].get<double>(), 0.5, 1e-6);
  EXPECT_EQ(told["target"][2], 0.5);
  EXPECT_EQ(told["fov"], 40.0);
  // It is the picture of a scene whose file says so.
  Description moved = shown_scene();
  for (const Child& child : moved.scene->children)
    if (child.object->family == "sensor")
      for (Property& property : child.object->properties) {
        if (property.name == "to_world")
          property.value = Transform::look_at({0.5, -4, 2}, {0, 0, 0.5}, {0, 0, 1});
        if (property.name == "fov") property.value = 40.0;
      }
  JobSettings settings;
  settings.session = shown_session();
  Job job(std::move(moved), std::move(settings));
  job.run();
  const Image expected = job.image();
  const auto snapshot = shown.server().engine().snapshot();
  const RgbView is = rgb_view(snapshot->picture), should = rgb_view(expected);
  for (size_t i = 0; i < expected.pixel_count(); ++i)
    ASSERT_NEAR(is[i].y, should[i].y, 1e-3f * (1 + should[i].y)) << i;
}

TEST(ViewRoutes, ResetIsTheSceneAsItWas) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const auto before = shown.server().engine().snapshot();
  const json camera = shown.get("/state")["camera"];
  ASSERT_EQ(shown.command({{"set", {{"ball.radius", 0.5}}}}).status, 200);
  ASSERT_EQ(
      shown.command({{"camera", {{"origin", {1, 1, 1}}, {"target", {0, 0, 0}}, {"up", {0, 0, 1}}}}})
          .status,
      200);
  EXPECT_NE(shown.get("/state")["camera"], camera);
  ASSERT_EQ(shown.command({{"do", "reset"}}).status, 200);
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_EQ(shown.get("/state")["camera"], camera);
  EXPECT_TRUE(same_bits(shown.server().engine().snapshot()->picture, before->picture));
}

TEST(ViewRoutes, ParametersAreListedAndSet) {
  ShownScene shown;
  const json list = shown.get("/parameters");
  const auto object = [](const json& all, const std::string& id) {
    for (const json& entry : all["objects"])
      if (entry["id"] == id) return entry;
    return json();
  };
  const auto parameter = [&](const json& all, const std::string& id, const std::string& name) {
    const json found = object(all, id);
    for (const json& entry : found["parameters"])
      if (entry["name"] == name) return entry;
    return json();
  };
  EXPECT_EQ(object(list, "ball")["type"], "sphere");
  EXPECT_NEAR(parameter(list, "ball", "radius")["value"].get<double>(), 0.3, 1e-9);
  EXPECT_EQ(parameter(list, "ball", "radius")["kind"], "number");
  EXPECT_EQ(parameter(list, "emitter", "radiance")["kind"], "color");
  EXPECT_EQ(parameter(list, "emitter", "radiance")["value"], json({9.0, 9.0, 9.0}));
  EXPECT_EQ(parameter(list, "film", "width")["value"], shown_width);
  EXPECT_EQ(parameter(list, "integrator", "max_depth")["kind"], "integer");
  EXPECT_EQ(list["integrators"][0], "auto");
  // The one that had no name has got one.
  EXPECT_EQ(object(list, "sphere")["type"], "sphere");
  EXPECT_EQ(object(list, "rectangle_2")["type"], "rectangle");

  ASSERT_TRUE(shown.wait_until_done());
  const double before = shown.get("/region?x=0&y=0&width=24&height=18")["mean"];
  const ClientResponse set = shown.command({{"set", {{"emitter.radiance", {18, 18, 18}}}}});
  ASSERT_EQ(set.status, 200) << set.body;
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_NEAR(shown.get("/region?x=0&y=0&width=24&height=18")["mean"].get<double>(), 2 * before,
              1e-4 * before);
  EXPECT_EQ(parameter(shown.get("/parameters"), "emitter", "radiance")["value"],
            json({18.0, 18.0, 18.0}));
  ASSERT_EQ(shown.command({{"integrator", "vcm"}}).status, 200);
  EXPECT_EQ(shown.get("/state")["integrator"], "vcm");
}

TEST(ViewRoutes, RefusedEditsKeepThePicture) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  const auto before = shown.server().engine().snapshot();
  const auto refused = [&](const json& command, const std::string& about) {
    const ClientResponse response = shown.command(command);
    EXPECT_EQ(response.status / 100, 4) << command;
    EXPECT_NE(response.body.find(about), std::string::npos) << response.body;
    EXPECT_TRUE(json::parse(response.body)["remedy"].is_string());
  };
  refused({{"set", {{"ball.radius", "wide"}}}}, "radius");
  refused({{"set", {{"ball.radius", -1}}}}, "radius");
  refused({{"set", {{"ball.radiuss", 1}}}}, "radius");
  refused({{"set", {{"bal.radius", 1}}}}, "ball");
  refused({{"set", {{"radius", 1}}}}, "object.parameter");
  refused({{"set", {{"ball.radius", nullptr}}}}, "ball.radius");
  refused({{"set", json::object()}}, "set");
  refused({{"integrator", "magic"}}, "magic");
  refused({{"do", "jump"}}, "jump");
  refused({{"fly", true}}, "fly");
  refused({{"do", "stop"}, {"integrator", "path"}}, "2 members");
  refused({{"camera", {{"origin", {0, 0, 0}}}}}, "target");
  refused({{"camera", {{"origin", {0, 0, 1}}, {"target", {0, 0, 1}}, {"up", {0, 0, 1}}}}},
          "target");
  refused({{"camera", {{"origin", {0, 0, 1e300}}, {"target", {0, 0, 1}}, {"up", {0, 1, 1}}}}},
          "origin");
  refused(
      {{"camera", {{"origin", {0, 0, 1}}, {"target", {0, 0, 0}}, {"up", {0, 1, 0}}, {"fov", 500}}}},
      "fov");
  EXPECT_EQ(shown.server().engine().snapshot(), before);
  // One that only building the scene finds out: it is told, and edits go on from before it.
  ASSERT_EQ(shown.command({{"set", {{"film.width", 1}, {"film.crop_width", 5}}}}).status, 200);
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_EQ(shown.server().engine().snapshot(), before);
  const json state = shown.get("/state");
  EXPECT_EQ(state["refusal"]["revision"], 2) << state;
  EXPECT_EQ(state["revision"], 1);
  ASSERT_EQ(shown.command({{"set", {{"ball.radius", 0.2}}}}).status, 200);
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_TRUE(shown.get("/state")["refusal"].is_null());
  EXPECT_EQ(shown.get("/state")["revision"], 3);
}

TEST(ViewRoutes, FilesOfTheMachineCannotBeNamed) {
  Description description = parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"photonmap\" id=\"method\"/>"
      "<sensor type=\"perspective\">" +
          film_of(8, 6) + "</sensor>" + room + "</scene>",
      "test.xml", "");
  ShownScene shown(shown_settings(), std::move(description));
  const ClientResponse response =
      shown.command({{"set", {{"integrator.photon_map", "/etc/passwd"}}}});
  EXPECT_EQ(response.status, 400) << response.body;
  EXPECT_NE(response.body.find("names a file"), std::string::npos);
  EXPECT_EQ(shown.get("/parameters").dump().find("photon_map\""), std::string::npos);
}

TEST(ViewRoutes, SavesByPlainNewNamesOnly) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("old.exr")) << "old";
  std::filesystem::create_symlink("/nowhere/else.exr", folder.path("link.exr"));
  view::ViewSettings settings = shown_settings();
  settings.output_folder = folder.path("");
  ShownScene shown(settings);
  ASSERT_TRUE(shown.wait_until_done());
  const auto save = [&](const std::string& name) {
    return shown.command({{"save", {{"name", name}}}});
  };
  for (const char* name : {"a.exr", "a b-c_1.png", "a.exr"}) {
    const ClientResponse response = save(name);
    EXPECT_EQ(response.status, 200) << response.body;
    EXPECT_TRUE(std::filesystem::exists(json::parse(response.body)["file"].get<std::string>()));
  }
  const Image saved = read_image(folder.path("a.exr"));
  EXPECT_GE(saved.find_channel("direct.R"), 0);
  for (const char* name : {"../a.exr", "/tmp/a.exr", "b/a.exr", "..", ".exr", ".a.exr", "a.txt",
                           "a", "", "-a.exr", "a\\b.exr", "a\nb.exr", "ä.exr"}) {
    const ClientResponse response = save(name);
    EXPECT_EQ(response.status, 400) << name << response.body;
  }
  EXPECT_EQ(save("old.exr").status, 409);
  EXPECT_EQ(save("link.exr").status, 409);
  EXPECT_EQ(save(std::string(200, 'a') + ".exr").status, 400);
  std::string old;
  std::ifstream(folder.path("old.exr")) >> old;
  EXPECT_EQ(old, "old");
  EXPECT_EQ(shown.command({{"save", "a.exr"}}).status, 400);
}

TEST(ViewRoutes, RegionsGetMoreSamples) {
  view::ViewSettings settings = shown_settings();
  settings.engine.session.is_endless = true;
  ShownScene shown(settings);
  const json region = {{"x", 3}, {"y", 4}, {"width", 8}, {"height", 6}, {"passes", 200}};
  const auto refine = [&](const json& change) {
    json asked = region;
    asked.update(change);
    return shown.command({{"refine", asked}});
  };
  const auto wait_for = [&](const std::function<bool(const json&)>& holds) {
    for (int i = 0; i < 6000; ++i) {
      if (holds(shown.get("/state"))) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  };
  ASSERT_TRUE(wait_for([](const json& state) { return state["passes"] > 0; }));
  for (const json& bad : std::vector<json>{{{"x", -1}},
                                           {{"x", 20}},
                                           {{"width", 0}},
                                           {{"height", 1e9}},
                                           {{"passes", 0}},
                                           {{"passes", 4097}},
                                           {{"passes", 1.5}},
                                           {{"y", nullptr}},
                                           {{"y", "4"}},
                                           {{"x", 18446744073709551615ull}},
                                           {{"more", 1}}}) {
    const ClientResponse response = refine(bad);
    EXPECT_EQ(response.status, 400) << bad << ": " << response.body;
    EXPECT_FALSE(json::parse(response.body)["remedy"].get<std::string>().empty());
  }
  EXPECT_EQ(shown.command({{"refine", 7}}).status, 400);
  EXPECT_EQ(shown.get("/state")["regions"], json::array());
  const ClientResponse taken = refine(json::object());
  EXPECT_EQ(taken.status, 200) << taken.body;
  ASSERT_TRUE(wait_for([](const json& state) { return state["regions"][0]["passes"] == 200; }));
  const json known = shown.get("/state")["regions"];
  EXPECT_EQ(
      known,
      json::array(
          {{{"x", 3}, {"y", 4}, {"width", 8}, {"height", 6}, {"passes", 200}, {"waiting", 0}}}));
  shown.command({{"do", "pause"}});
  const auto passes_at = [&](const std::string& pixel) {
    return shown.get("/pixel?" + pixel)["passes"].get<int>();
  };
  // The pass that runs may still end: what is asked before and after has to be the same.
  int outside = passes_at("x=13&y=6"), inside = 0;
  ASSERT_TRUE(wait_for([&](const json&) {
    const int before = outside;
    inside = passes_at("x=5&y=6");
    outside = passes_at("x=13&y=6");
    return outside == before;
  }));
  EXPECT_EQ(inside, 200 + outside);
  // Of a picture that is not rendered.
  shown.command({{"do", "stop"}});
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_EQ(refine(json::object()).status, 409);
}

TEST(ViewRoutes, PausesAndStops) {
  view::ViewSettings settings = shown_settings();
  settings.engine.session.passes = 1'000'000;
  ShownScene shown(settings);
  const auto within_seconds = [](const auto& holds) {
    for (int i = 0; i < 600; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  };
  const auto becomes = [&](const std::string& state) {
    return within_seconds([&] { return shown.get("/state")["state"] == state; });
  };
  EXPECT_TRUE(becomes("rendering"));
  EXPECT_TRUE(within_seconds([&] { return shown.ask("GET", "/pixel?x=1&y=1").status == 200; }));
  EXPECT_EQ(shown.command({{"do", "pause"}}).status, 200);
  EXPECT_TRUE(becomes("paused"));
  EXPECT_EQ(shown.command({{"do", "resume"}}).status, 200);
  EXPECT_TRUE(becomes("rendering"));
  EXPECT_EQ(shown.command({{"do", "stop"}}).status, 200);
  EXPECT_TRUE(becomes("idle"));
  EXPECT_EQ(shown.ask("GET", "/pixel?x=1&y=1").status, 200);
  EXPECT_EQ(shown.command({{"do", "start"}}).status, 200);
  EXPECT_TRUE(becomes("rendering"));
}

TEST(ViewRoutes, MessagesAreToldOnce) {
  std::mutex mutex;
  std::vector<std::string> warnings;
  Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\"><sensor type=\"perspective\">" + film_of(8, 6) +
                            "</sensor><shape type=\"sphere\" id=\"ball\"/></scene>",
                        "test.xml", "");
  const view::ViewServer server(std::move(description), shown_settings(),
                                {{}, [&](const std::string& text) {
                                   const std::lock_guard lock(mutex);
                                   warnings.push_back(text);
                                 }});
  ASSERT_TRUE(server.engine().wait_until_done(120s));
  HttpClient client(server.port());
  const std::string head = " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  const auto post = [&](const std::string& path, const std::string& cookie,
                        const std::string& body) {
    client.send("POST " + path + head + cookie + "Content-Length: " + std::to_string(body.size()) +
                "\r\n\r\n" + body);
    return client.response();
  };
  const std::string cookie =
      post("/session", "", "{\"token\":\"" + server.token() + "\"}").header("set-cookie");
  const std::string set = "{\"set\":{\"ball.radius\":2}}";
  ASSERT_EQ(post("/command", "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n", set).status,
            200);
  ASSERT_TRUE(server.engine().wait_until_done(120s));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(std::count_if(
                warnings.begin(), warnings.end(),
                [](const std::string& text) { return text.find("no light") != std::string::npos; }),
            1);
}

TEST(ViewRoutes, PlacesThatAreNotThere) {
  ShownScene shown;
  ASSERT_TRUE(shown.wait_until_done());
  EXPECT_EQ(shown.ask("GET", "/nothing").status, 404);
  EXPECT_EQ(shown.ask("POST", "/state", "{}").status, 405);
  EXPECT_EQ(shown.ask("GET", "/command").header("allow"), "POST");
  EXPECT_EQ(shown.ask("DELETE", "/").status, 405);
  for (const char* target :
       {"/pixel", "/pixel?x=1", "/pixel?x=1&y=-1", "/pixel?x=1&y=18", "/pixel?x=24&y=0",
        "/pixel?x=a&y=0", "/pixel?x=1&y=1&z=1", "/pixel?x=1&x=1&y=1", "/pixel?x=%1&y=1",
        "/pixel?x=99999999999999999999&y=1", "/region?x=0&y=0&width=0&height=1",
        "/region?x=0&y=0&width=25&height=1", "/region?x=1048576&y=0&width=1048576&height=1",
        "/frame?after=-1", "/frame?format=png", "/frame?width=0", "/state?x=1"}) {
    const ClientResponse response = shown.ask("GET", target);
    EXPECT_EQ(response.status, 400) << target << ": " << response.body;
    EXPECT_TRUE(json::parse(response.body)["error"].is_string());
  }
}

}  // namespace
}  // namespace kaustik::test
