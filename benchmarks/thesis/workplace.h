#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik::thesis {

/// Where experiments leave what they make: `docs` is what readers see (Markdown, plots, pictures),
/// `work` holds what can be made again (references, fragments of the page).
struct Workplace {
  std::filesystem::path docs, work;
  /// Multiplies the samples and times of the experiments; 1 is what the pages are made with, less
  /// is for trying them out.
  double effort = 1;
  int threads = 2;
  /// Of the experiments over many scenes: only these, by the names of their folders; empty: all.
  /// What was measured of the others before is kept.
  std::vector<std::string> scenes;

  /// At least 1.
  int scaled(int count) const;
  bool wants(const std::string& scene) const;
  /// Writes a text beside its place and renames it.
  void write_text(const std::filesystem::path& path, const std::string& text) const;
  /// Writes a picture into `docs`/pictures by a linear tone curve and returns the Markdown that
  /// shows it. `exposure` in stops.
  std::string show(const Image& image, const std::string& name, const std::string& alt,
                   float exposure, const std::string& layer = {}) const;
};

/// The whole file; "" if there is none.
std::string read_text(const std::filesystem::path& path);

/// One experiment; `run` returns its part of the page, in Markdown without the heading.
struct Experiment {
  const char* name;
  const char* title;
  std::string (*run)(const Workplace&);
};

/// In the order of the page.
const std::vector<Experiment>& experiments();

std::string walkthrough(const Workplace&);
std::string table_8_1(const Workplace&);
std::string figure_8_1(const Workplace&);
std::string stages(const Workplace&);
std::string irradiance_cache(const Workplace&);
std::string caustic_counts(const Workplace&);
std::string cone_constant(const Workplace&);
std::string global_coupling(const Workplace&);
std::string photon_parts(const Workplace&);
std::string maze_cache_quality(const Workplace&);

}  // namespace kaustik::thesis
