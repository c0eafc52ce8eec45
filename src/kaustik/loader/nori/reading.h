#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/file_search.h"
#include "kaustik/loader/nori/elements.h"

namespace kaustik::nori {

/// What all parts of a file share while they are read.
class Reading {
 public:
  Reading(std::filesystem::path folder, bool is_strict)
      : folder_(std::move(folder)), is_strict_(is_strict) {}

  /// Of a file that the scene names; one of a like name, which is told, where it is not there.
  /// None: there is none; that is told, with what `instead` says of the stand-in.
  std::optional<std::string> path_of(const std::string& name, const Place& place,
                                     const std::string& instead);
  /// Whether an OBJ file has normals; true for files that cannot be read.
  bool has_normals(const std::string& path);
  /// Tells that the nearest that there is stands for an element.
  void approximated(const Object& element, std::string what) {
    deviations.approximated(label_of(element), std::move(what), element.place);
  }
  void ignored(const Object& element, std::string what) {
    deviations.ignored(label_of(element), std::move(what), element.place);
  }

  /// Tells of the parts of an element, but for those in `taken`.
  void ignore_parts(const Object& element, const std::set<const Object*>& taken = {});

  Deviations deviations;
  /// Tests take the picture's mean: no filter may reach beyond its edges.
  bool has_box_filter = false;

 private:
  std::filesystem::path folder_;
  bool is_strict_;
  FileSearch search_;
  std::map<std::string, bool> has_normals_;
};

}  // namespace kaustik::nori
