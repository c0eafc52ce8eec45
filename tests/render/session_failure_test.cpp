// What goes wrong in an integrator ends the session with that error: nothing of it runs on, and the
// film holds the passes that were finished before. One integrator serves two sessions at once.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "kaustik/base/error.h"
#include "kaustik/base/parallel.h"
#include "kaustik/render/session.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;

/// That nothing else throws.
struct Planted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class FaultIn { light_pass, task_of_light_pass, sample };
constexpr FaultIn all_faults[] = {FaultIn::light_pass, FaultIn::task_of_light_pass,
                                  FaultIn::sample};

/// Pictures of noise. Of the pass with index `at` the first thread that comes there throws, once.
struct Failing {
  Failing(FaultIn fault, uint32_t at) {
    script.splats = true;
    script.prepare = [this, fault, at](const Pass& pass, SplatBuffer& splats) {
      const Inside inside(calls, running);
      splats.add({3.5f, 4.5f}, Component::caustic, Spectrum(float(pass.index + 1)), {});
      is_due = pass.index == at && !has_failed;
      if (fault == FaultIn::light_pass) fail_if_due();
      parallel_blocks(64, 1, [&](size_t, size_t, size_t block) {
        const Inside task(calls, running);
        if (fault == FaultIn::task_of_light_pass && block == 17) fail_if_due();
      });
    };
    script.sample = [this, fault](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
      const Inside inside(calls, running);
      if (fault == FaultIn::sample && raster.x > 9 && raster.y > 9) fail_if_due();
      sink.add(Component::direct, Spectrum(sampler.next_1d()));
    };
  }

  /// Counts who is in the integrator.
  struct Inside {
    Inside(std::atomic<int>& calls, std::atomic<int>& in) : running(in) {
      ++calls;
      ++running;
    }
    ~Inside() { --running; }
    std::atomic<int>& running;
  };
  void fail_if_due() {
    if (!is_due.exchange(false)) return;
    has_failed = true;
    throw Planted("planted");
  }

  Script script;
  std::atomic<bool> is_due = false, has_failed = false;
  std::atomic<int> calls = 0, running = 0;
};

/// What `run` throws, as its text.
template <typename Run>
std::string planted_error_of(const Run& run) {
  try {
    run();
  } catch (const Planted& error) {
    return error.what();
  }
  return "nothing";
}

SessionSettings of_passes(uint32_t passes) {
  SessionSettings settings;
  settings.passes = passes;
  settings.samples_per_pass = 3;
  settings.threads = 3;
  return settings;
}

TEST(SessionFailure, ExceptionsOfTheIntegratorReachTheCaller) {
  const auto scene = plain_scene();
  for (const FaultIn fault : all_faults) {
    SCOPED_TRACE(int(fault));
    Failing failing(fault, 2);
    const Scripted integrator(failing.script);
    // With a time that never comes a watch looks at the clock from a thread of its own.
    std::atomic<int> looks = 0;
    SessionSettings settings = of_passes(5);
    settings.seconds = 1e9;
    settings.clock = [&] { return 1e-6 * ++looks; };
    Session session(*scene, integrator, settings);
    EXPECT_EQ(planted_error_of([&] { session.run(); }), "planted");
    EXPECT_EQ(failing.running, 0);
    const int calls = failing.calls, looked = looks;
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    EXPECT_EQ(failing.calls, calls);
    EXPECT_EQ(looks, looked);

    // The film is that of the passes before, the twin one of another number of passes.
    Failing calm(fault, 1000);
    const Scripted calm_integrator(calm.script);
    Session two(*scene, calm_integrator, of_passes(2)), five(*scene, calm_integrator, of_passes(5));
    two.run();
    five.run();
    EXPECT_EQ(session.film().pass_count(), 2u);
    EXPECT_TRUE(same_bits(session.film().image(), two.film().image()));
    ASSERT_TRUE(session.snapshot());
    EXPECT_TRUE(same_bits(*session.snapshot(), two.film().image()));
    EXPECT_FALSE(same_bits(session.film().image(), five.film().image()));
  }
}

/// The same session may be run once more: it takes the passes that are missing.
TEST(SessionFailure, ASessionThatFailedCanGoOn) {
  const auto scene = plain_scene();
  for (const FaultIn fault : all_faults) {
    SCOPED_TRACE(int(fault));
    Failing calm(fault, 1000);
    const Scripted calm_integrator(calm.script);
    Session whole(*scene, calm_integrator, of_passes(3));
    whole.run();
    for (const uint32_t at : {0u, 1u, 2u}) {
      Failing failing(fault, at);
      const Scripted integrator(failing.script);
      Session session(*scene, integrator, of_passes(3));
      EXPECT_EQ(planted_error_of([&] { session.run(); }), "planted");
      EXPECT_EQ(session.film().pass_count(), at);
      EXPECT_EQ(planted_error_of([&] { session.run(); }), "nothing");
      EXPECT_EQ(session.film().pass_count(), 3u);
      EXPECT_TRUE(same_bits(session.film().image(), whole.film().image()));
    }
  }
}

std::unique_ptr<Integrator> integrator_of(const Scene& scene, const std::string& type) {
  const std::string few = type == "photonmap" ? "<integer name=\"caustic_photons\" value=\"3000\"/>"
                                                "<integer name=\"global_photons\" value=\"3000\"/>"
                                              : "";
  std::vector<std::string> warnings;
  return make_integrator(parse_mitsuba_xml("<scene version=\"3.0.0\"><integrator type=\"" + type +
                                               "\">" + few + "</integrator></scene>",
                                           "test.xml", ""),
                         scene, warnings);
}

/// What passes teach belongs to a seed: of two seeds in turns each begins anew, and traces again
/// what it has lost.
TEST(TwoSessions, OfOneIntegratorAtOnceHaveTheBitsThatTheyHaveAlone) {
  const auto scene = scene_with(film_of(12, 12), room);
  const auto session_of = [&](const Integrator& integrator, uint64_t seed) {
    SessionSettings settings;
    settings.passes = 3;
    settings.samples_per_pass = 2;
    settings.seed = seed;
    settings.threads = 2;
    return std::make_unique<Session>(*scene, integrator, settings);
  };
  for (const char* type : {"path", "photonmap", "vcm", "auto"}) {
    SCOPED_TRACE(type);
    std::vector<Image> alone;
    for (const uint64_t seed : {1u, 2u}) {
      const auto integrator = integrator_of(*scene, type);
      const auto session = session_of(*integrator, seed);
      session->run();
      alone.push_back(session->film().image());
    }
    EXPECT_FALSE(same_bits(alone[0], alone[1]));
    for (const uint64_t other : {1u, 2u}) {
      SCOPED_TRACE(other);
      const auto integrator = integrator_of(*scene, type);
      const auto a = session_of(*integrator, 1), b = session_of(*integrator, other);
      std::thread beside([&] { b->run(); });
      a->run();
      beside.join();
      EXPECT_TRUE(same_bits(a->film().image(), alone[0]));
      EXPECT_TRUE(same_bits(b->film().image(), alone[other - 1]));
    }
  }
}

}  // namespace
}  // namespace kaustik
