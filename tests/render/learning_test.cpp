// Lessons in files: learned once, for any number of renders, and kept in checkpoints.

#include "kaustik/render/learning.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kaustik/base/file.h"
#include "kaustik/render/checkpoint_merge.h"
#include "kaustik/render/job.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

Description little_room(const std::string& integrator, int size = 12, int samples = 0) {
  const std::string sampler =
      samples > 0 ? "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"" +
                        std::to_string(samples) + "\"/></sampler>"
                  : "";
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"" + integrator +
          "\"/><sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/>"
          "<transform name=\"to_world\"><lookat origin=\"0,-4,2\" target=\"0,0,0.5\" "
          "up=\"0,0,1\"/></transform>" +
          film_of(size, size) + sampler + "</sensor>" + room + "</scene>",
      "test.xml", "");
}

class LearningTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }

  static Learned learned_of(const std::string& integrator, uint32_t passes = 8,
                            std::stop_token stop = {}) {
    Description description = little_room(integrator);
    const PreparedScene prepared = prepare_scene(description, {}, true, {});
    LearningSettings settings;
    settings.passes = passes;
    return learn(prepared, settings, stop);
  }

  JobSettings part(uint32_t first, uint32_t count, const std::string& name) const {
    JobSettings settings;
    settings.session.first_pass = first;
    settings.session.passes = count;
    settings.session.samples_per_pass = 4;
    settings.record.program = "test";
    settings.record.plan.first_pass = first;
    settings.checkpoint = path(name);
    return settings;
  }

  TemporaryFolder folder_;
};

TEST_F(LearningTest, FilesHoldEverything) {
  StoredLessons stored = learned_of("auto").stored;
  stored.program = "1.2";
  stored.scene = "a.xml";
  write_lessons(path("a.kln"), stored);
  EXPECT_TRUE(is_lessons_file(path("a.kln")));
  const StoredLessons read = read_lessons(path("a.kln"));
  EXPECT_EQ(read.program, "1.2");
  EXPECT_EQ(read.scene, "a.xml");
  EXPECT_EQ(read.integrator, "auto");
  EXPECT_EQ(read.digest, stored.digest);
  EXPECT_EQ(read.samples_per_pass, stored.samples_per_pass);
  EXPECT_EQ(read.lessons, stored.lessons);
  EXPECT_EQ(read.lessons.passes, 8u);
  EXPECT_EQ(digest_of(read.lessons), digest_of(stored.lessons));
  EXPECT_NE(digest_of(read.lessons), digest_of(learned_of("auto", 4).stored.lessons));
}

TEST_F(LearningTest, DamagedFilesAreRefused) {
  write_lessons(path("a.kln"), learned_of("auto", 2).stored);
  const std::vector<uint8_t> bytes = read_file(path("a.kln"));
  const auto refused = [&](const std::vector<uint8_t>& wrong) {
    std::ofstream(path("b.kln"), std::ios::binary)
        .write(reinterpret_cast<const char*>(wrong.data()), std::ptrdiff_t(wrong.size()));
    EXPECT_THROW(read_lessons(path("b.kln")), Error);
  };
  for (size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40)
    refused({bytes.begin(), bytes.begin() + std::ptrdiff_t(size)});
  for (size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 40) {
    std::vector<uint8_t> wrong = bytes;
    wrong[at] ^= 4;
    refused(wrong);
  }
  EXPECT_THROW(read_lessons(path("none.kln")), Error);
  EXPECT_FALSE(is_checkpoint(path("a.kln")));
}

TEST_F(LearningTest, WhatLearnsNothingIsRefused) {
  try {
    learned_of("path");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find("integrator path learns nothing"), std::string::npos);
  }
  std::stop_source stopped;
  stopped.request_stop();
  try {
    learned_of("auto", 8, stopped.get_token());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::system);
  }
}

/// A picture must not be chosen by its own noise.
TEST_F(LearningTest, TeachesByPassesOfItsOwn) {
  const Description description = little_room("auto");
  const PreparedScene prepared = prepare_scene(description, {}, true, {});
  const uint32_t samples = prepared.integrator->traits().default_samples_per_pass;
  prepared.integrator->learn({0, 8, samples, {}}, {}, {});
  EXPECT_NE(prepared.integrator->lessons(), learned_of("auto").stored.lessons);
}

TEST_F(LearningTest, CheckpointsSpareEarlierPasses) {
  const auto photons = [](Job& job) { return job.run().report.photons; };
  Job whole(little_room("auto"), part(0, 12, "whole.kpt"));
  const uint64_t all = photons(whole);
  Job first(little_room("auto"), part(0, 9, "a.kpt"));
  const uint64_t before = photons(first);
  ASSERT_GT(before, 0u);

  JobSettings more = part(0, 12, "a.kpt");
  more.begun = read_checkpoint(path("a.kpt"));
  EXPECT_EQ(more.begun->lessons.passes, 9u);
  more.record = more.begun->record;
  Job second(little_room("auto"), std::move(more));
  EXPECT_EQ(photons(second), all - before);
  EXPECT_TRUE(same_bits(second.image(), whole.image()));
  EXPECT_EQ(read_checkpoint(path("a.kpt")).lessons, read_checkpoint(path("whole.kpt")).lessons);

  // Without the lessons all passes are traced once more.
  JobSettings forgetful = part(0, 12, "b.kpt");
  write_checkpoint(path("b.kpt"), first.wait().record, first.film());
  forgetful.begun = read_checkpoint(path("b.kpt"));
  forgetful.record = forgetful.begun->record;
  Job third(little_room("auto"), std::move(forgetful));
  EXPECT_GT(photons(third), all - before);
  EXPECT_TRUE(same_bits(third.image(), whole.image()));
}

TEST_F(LearningTest, MergedCheckpointsKeepTheLongerLessons) {
  for (const auto& [first, count, name] : {std::tuple(0u, 2u, "a.kpt"), {2u, 4u, "b.kpt"}}) {
    Job job(little_room("auto"), part(first, count, name));
    job.run();
  }
  const Checkpoint a = read_checkpoint(path("a.kpt")), b = read_checkpoint(path("b.kpt"));
  EXPECT_LT(a.lessons.passes, b.lessons.passes);
  Checkpoint ab = read_checkpoint(path("a.kpt")), ba = read_checkpoint(path("b.kpt"));
  merge_checkpoint(ab, "a.kpt", b, "b.kpt");
  merge_checkpoint(ba, "b.kpt", a, "a.kpt");
  EXPECT_EQ(ab.lessons, b.lessons);
  EXPECT_EQ(ba.lessons, b.lessons);
}

TEST_F(LearningTest, LearnedLessonsHoldForAllPasses) {
  const StoredLessons stored = learned_of("auto").stored;
  const auto rendered = [&](uint32_t first, uint32_t count, const std::string& name) {
    JobSettings settings = part(first, count, name);
    settings.session.samples_per_pass.reset();
    settings.learned = stored;
    Job job(little_room("auto"), std::move(settings));
    const JobResult& result = job.run();
    EXPECT_EQ(result.record.recipe.samples_per_pass, stored.samples_per_pass);
    EXPECT_EQ(result.record.recipe.lessons, digest_of(stored.lessons));
    return job.image();
  };
  const Image whole = rendered(0, 20, "whole.kpt");
  rendered(0, 10, "a.kpt");
  rendered(17, 3, "c.kpt");
  rendered(10, 7, "b.kpt");
  Checkpoint sum = read_checkpoint(path("c.kpt"));
  for (const char* name : {"a.kpt", "b.kpt"})
    merge_checkpoint(sum, "c.kpt", read_checkpoint(path(name)), name);
  EXPECT_TRUE(same_bits(sum.film.image(), whole));

  // Who goes on has them from the checkpoint.
  JobSettings more = part(0, 20, "a.kpt");
  more.begun = read_checkpoint(path("a.kpt"));
  more.record = more.begun->record;
  Job second(little_room("auto"), std::move(more));
  second.run();
  EXPECT_TRUE(same_bits(second.image(), whole));

  // Passes that learn for themselves do not belong to them.
  Job alone(little_room("auto"), part(20, 2, "alone.kpt"));
  alone.run();
  EXPECT_THROW(merge_checkpoint(sum, "c.kpt", read_checkpoint(path("alone.kpt")), "alone.kpt"),
               Error);
}

TEST_F(LearningTest, LessonsOfOtherScenesAreRefused) {
  const auto refused = [&](const std::string& integrator, int size, const std::string& message,
                           const std::function<void(StoredLessons&)>& change = {}) {
    JobSettings settings;
    settings.learned = learned_of("auto", 2).stored;
    settings.learned_path = "a.kln";
    if (change) change(*settings.learned);
    Job job(little_room(integrator, size), std::move(settings));
    try {
      job.prepare();
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("a.kln: "), 0u) << error.what();
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  refused("auto", 14, "another scene");
  refused("vcm", 12, "its lessons are of integrator auto, this is vcm");
  refused("auto", 12, "damaged", [](StoredLessons& stored) { stored.lessons.bytes.resize(40); });
}

TEST_F(LearningTest, LessonsAndACheckpointExcludeOneAnother) {
  Job first(little_room("auto"), part(0, 2, "a.kpt"));
  first.run();
  JobSettings both = part(0, 4, "a.kpt");
  both.begun = read_checkpoint(path("a.kpt"));
  both.record = both.begun->record;
  both.learned = learned_of("auto", 2).stored;
  Job second(little_room("auto"), std::move(both));
  EXPECT_THROW(second.prepare(), std::logic_error);
}

/// As many samples in all as without lessons, in passes as long as those that taught; unless it is
/// said how many a pass has.
TEST_F(LearningTest, SamplesAreThoseOfTheSceneOrAsSaid) {
  const auto described = [] { return little_room("auto", 12, 20); };
  StoredLessons stored;
  {
    Description description = described();
    const PreparedScene prepared = prepare_scene(description, {}, true, {});
    LearningSettings settings;
    settings.passes = 2;
    settings.samples_per_pass = 2;
    stored = learn(prepared, settings).stored;
  }
  const auto samples = [&](std::optional<uint32_t> per_pass) {
    JobSettings settings;
    settings.session.samples_per_pass = per_pass;
    settings.learned = stored;
    Job job(described(), std::move(settings));
    const JobResult& result = job.run();
    return std::pair(result.report.passes, result.report.samples_per_pass);
  };
  EXPECT_EQ(samples({}), (std::pair(10u, 2u)));
  EXPECT_EQ(samples(5), (std::pair(4u, 5u)));
}

TEST_F(LearningTest, AStopAfterTheLastPassIsNone) {
  const Description description = little_room("auto");
  const PreparedScene prepared = prepare_scene(description, {}, true, {});
  LearningSettings settings;
  settings.passes = 4;
  learn(prepared, settings);
  // All has been learned already.
  std::stop_source stopped;
  stopped.request_stop();
  const Learned again = learn(prepared, settings, stopped.get_token());
  EXPECT_FALSE(again.cancelled);
  EXPECT_EQ(again.stored.lessons.passes, 4u);
}

TEST_F(LearningTest, AnotherSceneForgetsThem) {
  JobSettings settings;
  settings.session.passes = 2;
  settings.learned = learned_of("auto", 2).stored;
  Job job(little_room("auto"), std::move(settings));
  job.run();
  job.edit(little_room("auto", 14));
  EXPECT_EQ(job.wait().report.passes, 2u);
}

}  // namespace
}  // namespace kaustik
