// Checkpoints: the same bits in parts as at once, and what is wrong with files is told.

#include "kaustik/render/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "kaustik/base/checksum.h"
#include "kaustik/base/file.h"
#include "kaustik/render/checkpoint_merge.h"
#include "kaustik/render/packed_sums.h"
#include "kaustik/render/session.h"
#include "tests/render/glass_ball_scene.h"
#include "tests/support/measure.h"
#include "tests/support/pass_of.h"
#include "tests/support/scene_text.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

const TestScene& little_scene() {
  static const TestScene scene(glass_ball_scene(8));
  return scene;
}

std::unique_ptr<Integrator> little_integrator(const std::string& type) {
  return quick_integrator(little_scene(), type);
}

SessionSettings settings_for(PassRange passes) {
  SessionSettings settings;
  settings.seed = 5;
  settings.first_pass = passes.begin;
  settings.passes = passes.end - passes.begin;
  settings.samples_per_pass = 2;
  return settings;
}

Film rendered(const Integrator& integrator, PassRange passes) {
  Session session(little_scene().scene(), integrator, settings_for(passes));
  session.run();
  return session.film();
}

void expect_same_bits(const Film& a, const Film& b) {
  const Image image_a = a.image(), image_b = b.image();
  ASSERT_EQ(image_a.channel_names(), image_b.channel_names());
  for (int c = 0; c < image_a.channel_count(); ++c)
    for (size_t i = 0; i < image_a.pixel_count(); ++i)
      ASSERT_EQ(image_a.channel(c)[i], image_b.channel(c)[i])
          << image_a.channel_names()[size_t(c)] << " of pixel " << i;
  EXPECT_EQ(a.mean_error(), b.mean_error());
  EXPECT_EQ(a.picture_error(), b.picture_error());
  EXPECT_EQ(a.passes().ranges(), b.passes().ranges());
}

RenderRecord little_record() {
  RenderRecord record;
  record.program = "1.2.3";
  record.instruction_sets = {"avx2", "avx512"};
  record.recipe.scene = "scene.xml";
  record.recipe.folder = "/somewhere";
  record.recipe.definitions = {{"size", "24"}, {"name", ""}};
  record.recipe.camera = "side";
  record.recipe.integrator = "path";
  record.recipe.settings = {{"film", "width", "8", "command line: --set film.width=8"}};
  record.recipe.seed = 0xfedcba9876543210u;
  record.recipe.samples_per_pass = 2;
  record.recipe.digest = {17, 18};
  record.plan = {3, 16, 60.0, 0.02, {{0, 64}, 4}};
  record.outputs.files = {"a.exr", "b.png"};
  record.outputs.tone = "linear";
  record.outputs.tone_settings = {"exposure=1"};
  record.outputs.full_float = true;
  record.view = {"path", 40, 30, Quantity::irradiance, 1.5, {}};
  record.seconds = 12.5;
  return record;
}

/// Made of one pass, with some negative sums.
Film little_film(PassRange passes = {3, 4}) {
  FilmSettings settings;
  settings.size = settings.crop_size = {3, 2};
  Film film(settings, {ComponentSet::all()});
  for (uint32_t pass = passes.begin; pass < passes.end; ++pass) {
    std::vector<PassPixel> pixels(6);
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i].radiance[i] = {float(i) + 0.1f, 3e-7f, 4e9f, 0};
      pixels[i].first_hit.normal = {-0.5f, 0.25f, -1e-12f};
    }
    film.add_pass(pass_of(pixels, settings.size), pass, 2);
  }
  return film;
}

class CheckpointFile : public testing::Test {
 protected:
  std::string path(const std::string& name = "a.kpt") const { return folder_.path(name); }
  std::vector<uint8_t> bytes() const { return read_file(path()); }
  void write(std::vector<uint8_t> bytes, bool with_checksum = false) const {
    if (with_checksum) {
      const uint64_t sum = checksum(std::span(bytes).first(bytes.size() - sizeof(uint64_t)));
      std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
    }
    std::ofstream(path(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ptrdiff_t(bytes.size()));
  }
  /// Reading must end with an input error that names the file.
  void expect_refused(const std::string& message) const {
    try {
      read_checkpoint(path());
      ADD_FAILURE() << "was read, expected: " << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(path()), std::string::npos) << error.what();
      EXPECT_FALSE(error.problems()[0].remedy.empty());
    }
  }
  static std::string merging(Checkpoint& whole, const Checkpoint& part) {
    try {
      merge_checkpoint(whole, "whole.kpt", part, "part.kpt");
    } catch (const Error& error) {
      EXPECT_FALSE(error.problems()[0].remedy.empty());
      return error.what();
    }
    return {};
  }

  TemporaryFolder folder_;
};

TEST_F(CheckpointFile, HoldsEverything) {
  const RenderRecord record = little_record();
  const Film film = little_film({4, 7});
  write_checkpoint(path(), record, film);
  EXPECT_TRUE(is_checkpoint(path()));
  const Checkpoint read = read_checkpoint(path());
  EXPECT_EQ(read.record.program, record.program);
  EXPECT_EQ(read.record.instruction_sets, record.instruction_sets);
  EXPECT_EQ(read.record.recipe.scene, record.recipe.scene);
  EXPECT_EQ(read.record.recipe.folder, record.recipe.folder);
  EXPECT_EQ(read.record.recipe.camera, record.recipe.camera);
  EXPECT_EQ(read.record.recipe.definitions, record.recipe.definitions);
  EXPECT_EQ(read.record.recipe.integrator, record.recipe.integrator);
  ASSERT_EQ(read.record.recipe.settings.size(), 1u);
  EXPECT_EQ(read.record.recipe.settings, record.recipe.settings);
  EXPECT_EQ(read.record.recipe.settings[0].origin, record.recipe.settings[0].origin);
  EXPECT_EQ(read.record.recipe.seed, record.recipe.seed);
  EXPECT_EQ(read.record.recipe.samples_per_pass, 2u);
  EXPECT_EQ(read.record.recipe.digest, record.recipe.digest);
  EXPECT_EQ(read.record.plan.first_pass, 3u);
  EXPECT_EQ(read.record.plan.passes, 16u);
  EXPECT_EQ(read.record.plan.seconds, 60.0);
  EXPECT_EQ(read.record.plan.error, 0.02);
  EXPECT_EQ(read.record.plan.division, record.plan.division);
  EXPECT_EQ(read.record.outputs.files, record.outputs.files);
  EXPECT_EQ(read.record.outputs.tone, "linear");
  EXPECT_EQ(read.record.outputs.tone_settings, record.outputs.tone_settings);
  EXPECT_TRUE(read.record.outputs.full_float);
  EXPECT_FALSE(read.record.outputs.denoise);
  EXPECT_EQ(read.record.view.vertical_fov, 30);
  EXPECT_EQ(read.record.view.quantity, Quantity::irradiance);
  EXPECT_EQ(read.record.view.exposure, 1.5);
  EXPECT_EQ(read.record.seconds, 12.5);
  expect_same_bits(read.film, film);
}

TEST_F(CheckpointFile, BytesInMemoryAreThoseOfTheFile) {
  write_checkpoint(path(), little_record(), little_film());
  const std::vector<uint8_t> made = checkpoint_bytes(little_record(), little_film());
  EXPECT_EQ(made, bytes());
  expect_same_bits(parse_checkpoint(made, "memory").film, little_film());
  try {
    parse_checkpoint({made.begin(), made.end() - 1}, "memory");
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(*error.problems()[0].place.file, "memory");
  }
}

TEST_F(CheckpointFile, PassesInPartsAreThoseOfOneRun) {
  for (const char* type : {"path", "photonmap", "vcm", "auto"}) {
    SCOPED_TRACE(type);
    const auto integrator = little_integrator(type);
    const Film whole = rendered(*integrator, {0, 8});
    write_checkpoint(path(), little_record(), rendered(*integrator, {0, 4}));

    // Gone on with, with an integrator that never saw the first passes.
    const auto later = little_integrator(type);
    Session session(little_scene().scene(), *later, settings_for({0, 8}),
                    read_checkpoint(path()).film);
    EXPECT_EQ(session.run().passes, 8u);
    expect_same_bits(session.film(), whole);

    // And put together, in any order.
    write_checkpoint(path("b.kpt"), little_record(), rendered(*later, {4, 6}));
    write_checkpoint(path("c.kpt"), little_record(), rendered(*little_integrator(type), {6, 8}));
    for (const std::vector<std::string>& order :
         {std::vector<std::string>{"a.kpt", "b.kpt", "c.kpt"}, {"c.kpt", "a.kpt", "b.kpt"}}) {
      Checkpoint sum = read_checkpoint(path(order[0]));
      for (size_t i = 1; i < order.size(); ++i)
        merge_checkpoint(sum, order[0], read_checkpoint(path(order[i])), order[i]);
      expect_same_bits(sum.film, whole);
      // Row by row, too.
      Checkpoint by_rows = read_checkpoint(path(order[0]));
      for (size_t i = 1; i < order.size(); ++i)
        merge_checkpoint_file(by_rows, order[0], path(order[i]));
      EXPECT_EQ(checkpoint_bytes(by_rows.record, by_rows.film, by_rows.lessons),
                checkpoint_bytes(sum.record, sum.film, sum.lessons));
    }
  }
}

/// What auto learns from pass to pass is in the test above: it traces light paths in this scene.
TEST_F(CheckpointFile, LittleSceneMakesAutoLearn) {
  SplatBuffer splats(little_scene().scene().film(), ComponentSet());
  const auto state = little_integrator("auto")->prepare({5, 0, 2}, splats, {}, {});
  ASSERT_FALSE(state->report.decisions.empty());
  EXPECT_NE(state->report.decisions[0].find("light paths per camera sample"), std::string::npos)
      << state->report.decisions[0];
  EXPECT_GT(state->report.photons, 0u);
}

TEST_F(CheckpointFile, GapsAreFilled) {
  const auto integrator = little_integrator("path");
  Film begun = rendered(*integrator, {1, 2});
  begun.add(rendered(*integrator, {3, 4}));
  Session session(little_scene().scene(), *integrator, settings_for({0, 5}), begun);
  std::vector<uint32_t> counts;
  session.run({}, {}, [&] { counts.push_back(session.film().pass_count()); });
  EXPECT_EQ(counts, (std::vector<uint32_t>{3, 4, 5}));
  expect_same_bits(session.film(), rendered(*integrator, {0, 5}));
}

TEST_F(CheckpointFile, WhatIsCompleteIsLeftAsItIs) {
  const auto integrator = little_integrator("path");
  const Film film = rendered(*integrator, {0, 3});
  Session session(little_scene().scene(), *integrator, settings_for({0, 3}), film);
  const SessionReport report = session.run();
  EXPECT_EQ(report.rays, 0u);
  EXPECT_EQ(report.passes, 3u);
  expect_same_bits(session.film(), film);
}

TEST_F(CheckpointFile, CancelledRendersHoldTheirFinishedPasses) {
  const auto integrator = little_integrator("path");
  std::stop_source source;
  Session session(little_scene().scene(), *integrator, settings_for({0, 8}));
  session.run(source.get_token(), {}, [&] {
    if (session.film().pass_count() == 3) source.request_stop();
  });
  expect_same_bits(session.film(), rendered(*integrator, {0, 3}));
}

TEST_F(CheckpointFile, MergingRefusesWhatDoesNotBelongTogether) {
  const auto checkpoint = [](PassRange passes) {
    return Checkpoint{little_record(), little_film(passes), {}};
  };
  const auto refused = [&](const std::string& message,
                           const std::function<void(Checkpoint&)>& change) {
    Checkpoint whole = checkpoint({0, 2}), part = checkpoint({2, 3});
    change(part);
    const std::string text = merging(whole, part);
    EXPECT_NE(text.find(message), std::string::npos) << text;
    EXPECT_NE(text.find("part.kpt: "), std::string::npos) << text;
    EXPECT_EQ(whole.film.pass_count(), 2u);
  };
  refused("another scene", [](Checkpoint& part) { part.record.recipe.digest.scene = 1; });
  refused("another integrator", [](Checkpoint& part) { part.record.recipe.digest.integrator = 1; });
  refused("it has other lessons", [](Checkpoint& part) { part.record.recipe.lessons = 1; });
  refused("it has seed 1 instead", [](Checkpoint& part) { part.record.recipe.seed = 1; });
  refused("it has 3 samples per pass instead of 2",
          [](Checkpoint& part) { part.record.recipe.samples_per_pass = 3; });
  refused("of its passes 1–4 were given before: 1", [&](Checkpoint& part) {
    part.film = little_film({1, 5});
  });
  refused("another size", [](Checkpoint& part) {
    FilmSettings settings;
    settings.size = settings.crop_size = {2, 2};
    part.film = Film(settings, {ComponentSet::all()});
  });
  Checkpoint whole = checkpoint({0, 2});
  EXPECT_EQ(merging(whole, checkpoint({2, 3})), "");
  expect_same_bits(whole.film, little_film({0, 3}));
}

TEST_F(CheckpointFile, AFrameHoldsTheFilm) {
  const auto write_with = [&](const PictureFrame& frame) {
    RenderRecord record = little_record();
    record.view.frame = frame;
    write_checkpoint(path(), record, little_film());
  };
  const Film film = little_film();
  const int width = film.width(), height = film.height();
  for (const PictureFrame& bad :
       {PictureFrame{5 + width, 0, 0, 0}, PictureFrame{0, 5 + height, 0, 0},
        PictureFrame{width, height, 1, 0}, PictureFrame{width, height, 0, 1},
        PictureFrame{width + 9, height + 9, -1, 0}, PictureFrame{width - 1, height, 0, 0},
        PictureFrame{0, 0, 3, 3}, PictureFrame{-width, -height, 0, 0}}) {
    write_with(bad);
    expect_refused("the frame of its picture is not valid");
  }
  for (const PictureFrame& good : {PictureFrame{}, PictureFrame{width, height, 0, 0},
                                   PictureFrame{width + 1, height + 2, 1, 2}}) {
    write_with(good);
    EXPECT_EQ(read_checkpoint(path()).record.view.frame, good);
  }
}

TEST_F(CheckpointFile, ForeignFilesAreRefused) {
  expect_refused("No such file");
  write({});
  expect_refused("not a checkpoint");
  EXPECT_FALSE(is_checkpoint(path()));
  const std::string text = "<scene version=\"3.0.0\"></scene>";
  write({text.begin(), text.end()});
  expect_refused("not a checkpoint");
  write_checkpoint(path(), little_record(), little_film());
  std::vector<uint8_t> other = bytes();
  std::reverse(other.begin() + 8, other.begin() + 12);
  write(other);
  expect_refused("other byte order");
  other = bytes();
  std::reverse(other.begin() + 8, other.begin() + 12);
  other[12] = 99;
  write(other);
  expect_refused("has version 99");
  // Its lessons are laid out otherwise.
  other[12] = 7;
  write(other);
  expect_refused("has version 7, this program reads version 18");
}

TEST_F(CheckpointFile, TruncatedAndDamagedFilesAreRefused) {
  write_checkpoint(path(), little_record(), little_film());
  const std::vector<uint8_t> whole = bytes();
  for (size_t size = 8; size < whole.size(); size += 1 + size / 37) {
    write({whole.begin(), whole.begin() + std::ptrdiff_t(size)});
    expect_refused("damaged");
  }
  std::vector<uint8_t> more = whole;
  more.push_back(0);
  write(more);
  expect_refused("damaged");
  for (size_t i = 16; i < whole.size(); i += 1 + i / 37) {
    std::vector<uint8_t> flipped = whole;
    flipped[i] ^= 0x10;
    write(flipped);
    expect_refused("damaged");
  }
}

/// Behind a checksum that is right there may be anything: it is an error or a checkpoint, and it
/// takes neither time nor memory out of proportion.
TEST_F(CheckpointFile, WrongContentsDoNoHarm) {
  write_checkpoint(path(), little_record(), little_film());
  const std::vector<uint8_t> whole = bytes();
  std::mt19937 generator(3);
  const auto any = [&](size_t end) {
    return std::uniform_int_distribution<size_t>(0, end - 1)(generator);
  };
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::vector<uint8_t> changed = whole;
    const size_t at = 16 + any(whole.size() - 24);
    if (i % 3 == 0)
      for (size_t k = at; k < std::min(at + 8, whole.size() - 8); ++k) changed[k] = 0xff;
    else if (i % 3 == 1)
      changed[at] = uint8_t(any(256));
    else
      changed.erase(changed.begin() + std::ptrdiff_t(at));
    write(changed, true);
    try {
      const Checkpoint read = read_checkpoint(path());
      read.film.image();
      EXPECT_EQ(read.film.width() * read.film.height() > 0, true);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

/// Numbers that no render has, though they can be read: going on from them would go wrong.
TEST_F(CheckpointFile, NumbersOutOfRangeAreRefused) {
  const auto refused = [&](const std::string& message, PassRange passes,
                           const std::function<void(RenderRecord&)>& change) {
    SCOPED_TRACE(message);
    RenderRecord record = little_record();
    record.plan.first_pass = passes.begin;
    change(record);
    write_checkpoint(path(), record, little_film(passes));
    expect_refused(message);
  };
  refused("its passes are not valid", {0xfffffffe, 0xffffffff},
          [](RenderRecord& record) { record.plan.first_pass = 0; });
  refused("its passes are not valid", {0x80000000, 0x80000001},
          [](RenderRecord& record) { record.plan.first_pass = 0; });
  refused("the passes that it was to have are not valid", {0, 1},
          [](RenderRecord& record) { record.plan.first_pass = 0xfffffff0; });
  refused("the passes that it was to have are not valid", {1, 2},
          [](RenderRecord& record) { record.plan.passes = 0x80000000; });
  refused("its passes come before", {0, 1},
          [](RenderRecord& record) { record.plan.first_pass = 1; });
  refused("samples of its passes are not valid", {0, 1},
          [](RenderRecord& record) { record.recipe.samples_per_pass = 0xffffffff; });
  refused("do not have the samples", {0, 1},
          [](RenderRecord& record) { record.recipe.samples_per_pass = 3; });
  for (const PassDivision& division :
       {PassDivision{{3, 19}, 17}, PassDivision{{3, 18}, 2}, PassDivision{{4, 20}, 2},
        PassDivision{{3, 0x80000001}, 2}, PassDivision{{0, 1}, 0}})
    refused("the parts of its passes are not valid", {3, 4},
            [&](RenderRecord& record) { record.plan.division = division; });
  RenderRecord record = little_record();
  record.plan = {0x7ffffffe, 2, {}, {}};
  write_checkpoint(path(), record, little_film({0x7ffffffe, 0x80000000}));
  EXPECT_EQ(read_checkpoint(path()).film.pass_count(), 2u);
}

TEST_F(CheckpointFile, WritingReplacesTheFileAsAWhole) {
  write_checkpoint(path(), little_record(), little_film());
  const std::vector<uint8_t> old = bytes();
  EXPECT_THROW(write_checkpoint(path("nowhere/a.kpt"), little_record(), little_film()), Error);
  write_checkpoint(path(), little_record(), little_film({3, 5}));
  EXPECT_NE(bytes(), old);
  EXPECT_EQ(read_checkpoint(path()).film.pass_count(), 2u);
}

/// Memory that the program may still take, in its life.
class LittleMemory {
 public:
  explicit LittleMemory(rlim_t bytes) {
    std::ifstream status("/proc/self/status");
    std::string word;
    rlim_t used = 0;
    while (status >> word && word != "VmData:") {
    }
    status >> used;
    ::getrlimit(RLIMIT_DATA, &before_);
    const rlimit limit{used * 1024 + bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  ~LittleMemory() { ::setrlimit(RLIMIT_DATA, &before_); }

 private:
  rlimit before_;
};

Film noisy_film(int side) {
  FilmSettings settings;
  settings.size = settings.crop_size = {side, side};
  Film film(settings, {ComponentSet::all()});
  std::mt19937 generator(5);
  std::exponential_distribution<float> light(1);
  std::vector<PassPixel> pixels(film.pixel_count());
  for (PassPixel& pixel : pixels)
    for (auto& radiance : pixel.radiance)
      radiance = {light(generator), light(generator), light(generator), 0};
  film.add_pass(pass_of(pixels, settings.size), 0, 1);
  return film;
}

/// Then the render goes on, or writes its picture: an Error, and nothing is left behind.
TEST_F(CheckpointFile, LittleMemoryIsAnError) {
  if (slow_build) GTEST_SKIP() << "sanitizers take memory of their own";
  const Film film = noisy_film(300);
  // About that of the file, too.
  const size_t size = film.bytes();
  ASSERT_GT(size, size_t{8} << 20);
  const auto write = [&] { write_checkpoint(path(), little_record(), film); };
  {
    const LittleMemory little(size / 2);
    try {
      write();
      ADD_FAILURE() << "was written";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::system);
      EXPECT_NE(std::string(error.what()).find("not enough memory"), std::string::npos);
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(path()).parent_path()));
  {
    // The file is held in memory once.
    const LittleMemory enough(size + size / 2);
    write();
  }
  EXPECT_GT(bytes().size(), size * 3 / 4);
}

constexpr BinaryFileKind sums_kind = {
    {0x89, 'T', 'S', 'T', '\r', '\n', 0x1a, '\n'}, 1, "file of sums", "", ""};

TEST_F(CheckpointFile, PackedSumsComeBack) {
  std::vector<Fixed> sums = {0, 1, -1, 127, 128, 255, 256, -127, -128, -129, -256};
  for (int shift = 0; shift < 126; ++shift)
    for (const int factor : {1, -1, 3, -3})
      if (shift < 124) sums.push_back(Fixed(factor) * (Fixed(1) << shift));
  std::mt19937_64 generator(4);
  // More than are read at a time.
  for (int i = 0; i < 400'000; ++i)
    sums.push_back(Fixed(UnsignedFixed(generator()) << 64 | generator()) >> (i % 127));
  BinaryWriter writer(sums_kind);
  put_sums(writer, sums);
  writer.write_to(path());
  // Half of the bits, as they are shifted, and a byte that tells how many.
  EXPECT_LT(bytes().size(), 10 * sums.size());
  BinaryReader reader(sums_kind, path());
  EXPECT_TRUE(get_sums(reader, sums.size()) == sums);
  reader.expect_end();
  EXPECT_THROW(get_sums(reader, 1), Error);
}

TEST_F(CheckpointFile, WhatIsNoPackedSumIsRefused) {
  using Bytes = std::vector<uint8_t>;
  // More kept bytes than follow, none, a first one behind the last, and the number without
  // opposite.
  for (const Bytes& packed :
       {Bytes{0xf0, 1, 2, 3}, Bytes{0x10, 1}, Bytes{0x23}, Bytes{0x12, 5, 5}, Bytes{0xff, 0x80}}) {
    for (const size_t before : {0, 40}) {
      BinaryWriter writer(sums_kind);
      put_sums(writer, std::vector<Fixed>(before, -300));
      writer.put_bytes(packed.data(), packed.size());
      writer.write_to(path());
      BinaryReader reader(sums_kind, path());
      try {
        get_sums(reader, before + 1);
        ADD_FAILURE() << "code " << int(packed[0]);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("file of sums is damaged"), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace kaustik
