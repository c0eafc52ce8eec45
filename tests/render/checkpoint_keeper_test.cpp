// Who may write a checkpoint's file when two processes render the same part.

#include "kaustik/render/checkpoint_keeper.h"

#include <gtest/gtest.h>

#include <barrier>
#include <filesystem>
#include <thread>

#include "tests/support/film.h"
#include "tests/support/scripted_integrator.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::test {
namespace {

Film film_with(PassRange passes) {
  Film film(film_of_size(2, 1), {ComponentSet::all()});
  for (uint32_t pass = passes.begin; pass < passes.end; ++pass)
    film.add_pass(tiled(grey_pixels(1, 2), film), pass, 1);
  return film;
}

class SharedCheckpoint : public testing::Test {
 protected:
  SharedCheckpoint() {
    record_.recipe.samples_per_pass = 1;
    record_.plan.passes = 8;
  }
  CheckpointKeeper keeper(CheckpointOwner owner) {
    return {path_,   owner,       0,
            record_, integrator_, [this](const std::string& text) { warnings_.push_back(text); }};
  }
  void put(PassRange passes) const { write_checkpoint(path_, record_, film_with(passes), {}); }
  std::string passes_there() const { return read_checkpoint(path_).film.passes().text(); }

  TemporaryFolder folder_;
  std::string path_ = folder_.path("part.kpt");
  RenderRecord record_;
  Scripted integrator_{Script{}};
  std::vector<std::string> warnings_;
};

TEST_F(SharedCheckpoint, OneOfMorePassesStays) {
  put({0, 5});
  CheckpointKeeper slow = keeper(CheckpointOwner::perhaps_several);
  slow.pass_done(film_with({0, 3}));
  slow.write_last(film_with({0, 4}));
  EXPECT_EQ(passes_there(), "0–4");
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("holds more passes"), std::string::npos) << warnings_[0];
  slow.write_last(film_with({0, 6}));
  EXPECT_EQ(passes_there(), "0–5");
}

TEST_F(SharedCheckpoint, OthersAreReplaced) {
  // Of as many passes, or of more which do not hold all of these.
  for (const PassRange& there : {PassRange{0, 3}, PassRange{1, 8}}) {
    put(there);
    keeper(CheckpointOwner::perhaps_several).write_last(film_with({0, 3}));
    EXPECT_EQ(passes_there(), "0–2");
  }
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(SharedCheckpoint, TheOneOfMostPassesStaysWhoeverIsLast) {
  // Each writes its film again and again, all at the same time.
  constexpr uint32_t writers = 6, rounds = 20;
  std::vector<Film> films;
  for (uint32_t i = 0; i < writers; ++i) films.push_back(film_with({0, 1 + i}));
  for (uint32_t round = 0; round < rounds; ++round) {
    std::filesystem::remove(path_);
    std::barrier start(writers);
    std::vector<std::jthread> threads;
    for (const Film& film : films)
      threads.emplace_back([&] {
        CheckpointKeeper writer(path_, CheckpointOwner::perhaps_several, 0, record_, integrator_,
                                {});
        start.arrive_and_wait();
        writer.write_last(film);
      });
    threads.clear();
    ASSERT_EQ(passes_there(), film_with({0, writers}).passes().text()) << "round " << round;
  }
}

TEST_F(SharedCheckpoint, WhoIsAloneReplacesWhatIsThere) {
  put({0, 5});
  keeper(CheckpointOwner::one).write_last(film_with({0, 3}));
  EXPECT_EQ(passes_there(), "0–2");
}

}  // namespace
}  // namespace kaustik::test
