// Photon maps that are larger than memory: parts merged on the disk, then gathered from through the
// mapped file.
//
// "merge-memory" is the largest memory of its own that the merging process has (its heap and
// stacks; what the system keeps of files it gives up when it needs the room). "merge-speed" is
// photons per second of processor time. "gather-mapped" is how often the time from a map that is
// built in memory goes into that from a mapped file that the system has in memory, in processor
// time of one thread, for the nearest 50 of places one beside the other, as a picture's rows ask
// for them.
//
// `large_map_bench [PHOTONS] [FOLDER] [in-memory|no]`: 20 million, in parts of 4 million each; in
// the folder of temporary files; "no" leaves out the map in memory, which takes 110 bytes a photon
// to build.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <thread>

#include "benchmarks/report.h"
#include "kaustik/photon/photon_parts.h"

namespace {

using namespace kaustik;

constexpr size_t photons_per_part = 4'000'000;
constexpr bench::Bar memory_bar{1, 2};  // how often it goes into a GiB
constexpr bench::Bar gather_bar{0.5, 0.9};

double processor_seconds() {
  timespec time;
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Six walls of a room, on one of which light is focused.
void make_part(size_t first, size_t count, std::vector<Vec3f>& positions,
               std::vector<Photon>& photons) {
  std::mt19937_64 random(first);
  std::uniform_real_distribution<float> even(0, 1);
  for (size_t i = 0; i < count; ++i) {
    const auto wall = int(random() % 6);
    Vec3f at{even(random), even(random), even(random)}, side{0, 0, 0};
    at[wall / 2] = float(wall % 2);
    side[wall / 2] = wall % 2 == 0 ? 1.0f : -1.0f;
    if (i % 4 == 0 && wall < 2) at.y = 0.5f + 0.1f * (at.y - 0.5f) * at.z;
    Photon photon;
    photon.side = CoarseNormal(side);
    photon.path = uint32_t(first + i);
    photon.flux.lanes = {1, 1, 1, 0};
    positions.push_back(at);
    photons.push_back(photon);
  }
}

/// In a process of its own, whose memory is none of this one's. What `body` returns.
template <typename Body>
double apart(const Body& body) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start a process");
  if (child == 0) {
    const double result = body();
    const bool is_told = ::write(ends[1], &result, sizeof result) == sizeof result;
    ::_exit(is_told ? 0 : 1);
  }
  double result = 0;
  const bool is_told = ::read(ends[0], &result, sizeof result) == sizeof result;
  int status = 0;
  if (::waitpid(child, &status, 0) != child || status != 0 || !is_told)
    throw std::runtime_error("a process has failed");
  ::close(ends[0]);
  ::close(ends[1]);
  return result;
}

/// Of this process, heap and stacks, in MB.
double own_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "RssAnon:") {
      double kilobytes = 0;
      status >> kilobytes;
      return kilobytes / 1024;
    }
  return 0;
}

/// The most that own_megabytes() has been meanwhile.
class Watch {
 public:
  Watch()
      : thread_([this](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            most_ = std::max(most_, own_megabytes());
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  double most() {
    thread_.request_stop();
    thread_.join();
    return most_;
  }

 private:
  double most_ = 0;
  std::jthread thread_;
};

class Folder {
 public:
  explicit Folder(const std::filesystem::path& where) {
    std::string pattern = (where / "large_map_XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::vector<std::string> write_parts(const Folder& folder, size_t photons) {
  const auto count = uint32_t((photons + photons_per_part - 1) / photons_per_part);
  std::vector<std::string> files;
  for (uint32_t i = 0; i < count; ++i) {
    files.push_back(folder.file(fmt::format("part_{}.kpm", i + 1)));
    apart([&] {
      const size_t first = i * photons_per_part;
      std::vector<Vec3f> positions;
      std::vector<Photon> data;
      make_part(first, std::min(photons_per_part, photons - first), positions, data);
      StoredPhotons part;
      part.settings.part = {i, count};
      part.maps.global = PhotonMap(std::move(positions), std::move(data));
      write_photon_file(files.back(), part);
      return 0.0;
    });
  }
  return files;
}

void measure_merging(const std::vector<std::string>& files, const std::string& whole,
                     size_t photons) {
  const std::string compared =
      fmt::format("{} photons in {} files of {:.0f} MB", photons, files.size(),
                  double(std::filesystem::file_size(files.front())) / 1e6);
  double seconds = 0;
  const double megabytes = apart([&] {
    Watch watch;
    std::vector<StoredPhotons> parts;
    for (const std::string& file : files) parts.push_back(read_photon_file(file));
    write_merged_photons(whole, parts);
    std::ofstream(whole + ".seconds") << processor_seconds();
    return watch.most();
  });
  std::ifstream(whole + ".seconds") >> seconds;
  bench::report("merge-memory", 1024 / megabytes, "times its memory is a GiB",
                fmt::format("{}: {:.0f} MB", compared, megabytes), memory_bar);
  bench::report("merge-speed", double(photons) / seconds / 1e6, "million photons/s of a core",
                fmt::format("{}: {:.0f} s", compared, seconds));
}

/// Seconds of a processor; places go through a map as the rows of a picture do.
double gather_seconds(const PhotonMap& map, const EstimateSettings& estimate) {
  constexpr int rows = 100;
  Scratch scratch;
  double sum = 0;
  const double begin = processor_seconds();
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < 500; ++x) {
      const Vec3f at{0, (float(y) + 0.5f) / float(rows), (float(x) + 0.5f) / 500};
      sum += map.irradiance(at, {1, 0, 0}, estimate, scratch).value[0];
    }
  const double seconds = processor_seconds() - begin;
  if (!(sum > 0)) throw std::runtime_error("there is no light");
  return seconds;
}

double best_gather_seconds(const PhotonMap& map) {
  EstimateSettings estimate;
  estimate.neighbors = 50;
  // As integrators have it for stored maps.
  estimate.maximum_radius = 2 * map.typical_radius(estimate.neighbors, 0.95f);
  gather_seconds(map, estimate);  // brings it into memory
  double best = gather_seconds(map, estimate);
  for (int i = 0; i < 4; ++i) best = std::min(best, gather_seconds(map, estimate));
  return best;
}

void measure_gathering(const std::string& whole, size_t photons, bool in_memory) {
  double megabytes = 0;
  const double mapped = apart([&] {
    const StoredPhotons stored = read_photon_file(whole);
    const double seconds = best_gather_seconds(stored.maps.global);
    std::ofstream(whole + ".memory") << own_megabytes();
    return seconds;
  });
  std::ifstream(whole + ".memory") >> megabytes;
  bench::report("gather-memory", 1024 / megabytes, "times its memory is a GiB",
                fmt::format("{} photons mapped: {:.0f} MB", photons, megabytes), memory_bar);
  bench::report("gather-speed", 50'000 / mapped / 1e6, "million estimates/s of a core",
                "from the mapped file, 50 photons each");
  if (!in_memory) return;
  const double built = apart([&] {
    std::vector<Vec3f> positions;
    std::vector<Photon> data;
    for (size_t first = 0; first < photons; first += photons_per_part)
      make_part(first, std::min(photons_per_part, photons - first), positions, data);
    return best_gather_seconds(PhotonMap(std::move(positions), std::move(data)));
  });
  bench::report("gather-mapped", built / mapped, "of the speed from a map built in memory",
                fmt::format("{} photons, 50 found", photons), gather_bar);
}

}  // namespace

int main(int argc, char** argv) {
  const size_t photons = argc > 1 ? size_t(std::atoll(argv[1])) : 20'000'000;
  const Folder folder(argc > 2 ? std::filesystem::path(argv[2])
                               : std::filesystem::temp_directory_path());
  const std::string whole = folder.file("whole.kpm");
  measure_merging(write_parts(folder, photons), whole, photons);
  measure_gathering(whole, photons, argc <= 3 || std::string(argv[3]) != "no");
}
