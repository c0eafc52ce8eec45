// How fast checkpoints of a picture's parts are merged, and what it takes in memory. The files are
// in the page cache, as after a network disk has brought them.
//
// "merge-speed" is bytes of files per second of processor time, of all threads together, from the
// second file on: checksum, unpacking, adding. "merge-memory" is the largest memory of the process
// after 2 files, and what the film has grown by since (sums of more passes have more bits), beside
// the largest after 64 files.
//
// `merge_bench [WIDTH]`: of the picture, 1280 if it is not told; its files take about a hundred
// bytes a pixel times four.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>

#include "benchmarks/report.h"
#include "kaustik/render/checkpoint_merge.h"

namespace {

using namespace kaustik;

constexpr bench::Bar speed_bar{500, 1000};
constexpr bench::Bar memory_bar{0.95, 1};
constexpr uint32_t passes_per_part = 2;

double processor_seconds() {
  rusage used;
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double peak_megabytes() {
  rusage used;
  ::getrusage(RUSAGE_SELF, &used);
  return double(used.ru_maxrss) / 1024;
}

/// Pixels of a scene of which all components are lit, and noisy.
PassTiles noisy_pass(const Vec2i& size, uint32_t seed) {
  PassTiles pass(size);
  std::mt19937 generator(seed);
  std::exponential_distribution<float> light(3);
  std::normal_distribution<float> around(0, 1);
  const auto pixels = std::make_unique<PassTiles::Pixels>();
  for (size_t tile = 0; tile < pass.tiles().count(); ++tile) {
    for (PassPixel& pixel : *pixels) {
      for (auto& radiance : pixel.radiance)
        radiance = {light(generator), light(generator), light(generator), 0};
      pixel.first_hit.normal = {around(generator), around(generator), around(generator)};
    }
    pass.store(tile, *pixels);
  }
  return pass;
}

RenderRecord record_of(uint32_t first) {
  RenderRecord record;
  record.recipe.samples_per_pass = 1;
  record.plan.first_pass = first;
  record.plan.passes = passes_per_part;
  return record;
}

/// In a process of its own, whose memory is none of this one's.
template <typename Body>
void apart(const Body& body) {
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start a process");
  if (child == 0) {
    body();
    ::_exit(0);
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error("the parts could not be made");
}

class Parts {
 public:
  Parts(int width, size_t count) {
    std::string pattern = (std::filesystem::temp_directory_path() / "merge_bench_XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    for (size_t i = 0; i < count; ++i)
      files_.push_back((folder_ / fmt::format("part_{}.kpt", i + 1)).string());
    apart([&] { write({width, width * 9 / 16}); });
  }
  ~Parts() { std::filesystem::remove_all(folder_); }
  size_t count() const { return files_.size(); }
  const std::string& file(size_t i) const { return files_[i]; }
  double megabytes(size_t i) const { return double(std::filesystem::file_size(files_[i])) / 1e6; }

 private:
  void write(const Vec2i& size) const {
    FilmSettings settings;
    settings.size = settings.crop_size = size;
    for (uint32_t i = 0; i < files_.size(); ++i) {
      const uint32_t first = i * passes_per_part;
      Film film(settings, {ComponentSet::all()});
      for (uint32_t pass = first; pass < first + passes_per_part; ++pass)
        film.add_pass(noisy_pass(size, pass), pass, 1);
      write_checkpoint(files_[i], record_of(first), film, {});
    }
  }

  std::filesystem::path folder_;
  std::vector<std::string> files_;
};

void measure_speed(const Parts& parts) {
  Checkpoint whole = read_checkpoint(parts.file(0));
  double megabytes = 0;
  const double begin_s = processor_seconds();
  const double wall_s = bench::seconds_of([&] {
    for (size_t i = 1; i < parts.count(); ++i) {
      merge_checkpoint_file(whole, parts.file(0), parts.file(i));
      megabytes += parts.megabytes(i);
    }
  });
  const double processor_s = processor_seconds() - begin_s;
  const std::string files = fmt::format("{} files of {:.0f} MB", parts.count() - 1,
                                        megabytes / double(parts.count() - 1));
  bench::report("merge-speed", megabytes / processor_s, "MB/s of a core", files, speed_bar);
  bench::report("merge-speed-wall", megabytes / wall_s, "MB/s", files);
}

void measure_memory(const Parts& parts) {
  constexpr double megabyte = 1 << 20;
  Checkpoint whole = read_checkpoint(parts.file(0));
  double of_two = 0, film_of_two = 0;
  for (size_t i = 1; i < parts.count(); ++i) {
    merge_checkpoint_file(whole, parts.file(0), parts.file(i));
    if (i > 1) continue;
    of_two = peak_megabytes();
    film_of_two = double(whole.film.bytes()) / megabyte;
  }
  const double film = double(whole.film.bytes()) / megabyte;
  bench::report(
      "merge-memory", (of_two + film - film_of_two) / peak_megabytes(),
      fmt::format("of the memory that {} files take", parts.count()),
      fmt::format("2 files: {:.1f} MB, film {:.1f} MB; {} files: {:.1f} MB, film {:.1f} MB", of_two,
                  film_of_two, parts.count(), peak_megabytes(), film),
      memory_bar);
}

}  // namespace

int main(int argc, char** argv) {
  // Before this process has threads.
  const Parts small(240, 64), large(argc > 1 ? std::atoi(argv[1]) : 1280, 4);
  // First: it looks at the largest memory so far.
  measure_memory(small);
  measure_speed(large);
}
