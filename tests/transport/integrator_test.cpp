#include "kaustik/transport/integrator.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

TEST(SampleSink, SumsAllLightThatIsFinite) {
  SampleSink sink(ComponentSet::all());
  EXPECT_EQ(sink.all_light(), 0);
  sink.add(Component::direct, Spectrum(1, 2, 3, 0));
  sink.add(Component::caustic, Spectrum(0.5f, 0, 0, 0));
  EXPECT_EQ(sink.all_light(), 6.5);
  sink.add(Component::indirect, Spectrum(1, infinity, 1, 0));
  EXPECT_EQ(sink.all_light(), 6.5);
}

TEST(SampleSink, HasScratchOfItsOwnOrItsCallers) {
  Scratch scratch;
  SampleSink one(ComponentSet::all(), {}, &scratch), other(ComponentSet::all(), {}, &scratch);
  EXPECT_EQ(&one.scratch(), &scratch);
  EXPECT_EQ(&other.scratch(), &scratch);
  SampleSink alone(ComponentSet::all());
  EXPECT_NE(&alone.scratch(), &scratch);
  EXPECT_EQ(&alone.scratch(), &alone.scratch());
}

struct OneState final : PassState {
  int number = 7;
};
struct OtherState final : PassState {};

TEST(PassState, IsAskedForAsWhatItIs) {
  const OneState one;
  const PassState& state = one;
  EXPECT_EQ(state_as<OneState>(state).number, 7);
#ifndef NDEBUG
  EXPECT_DEATH(state_as<OtherState>(state), "of another integrator");
#endif
}

}  // namespace
}  // namespace kaustik
