#pragma once
// Where a reader could not take a scene as it is written: what it approximated, ignored or missed.

#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Collects deviations while a file is read. Alike ones of one object count once.
class Deviations {
 public:
  /// Adds one: `object` names the object in terms of the file ("material 'glass'"), `what` is a
  /// sentence without a full stop ("hair is rendered as a rough dielectric").
  void add(DeviationKind kind, std::string object, std::string what, Place place);

  void approximated(std::string object, std::string what, Place place) {
    add(DeviationKind::approximated, std::move(object), std::move(what), std::move(place));
  }
  void ignored(std::string object, std::string what, Place place) {
    add(DeviationKind::ignored, std::move(object), std::move(what), std::move(place));
  }
  void missing(std::string object, std::string what, Place place) {
    add(DeviationKind::missing, std::move(object), std::move(what), std::move(place));
  }

  /// Puts them into the description. Throws Error(input) with one problem for each if the reader is
  /// strict and there are any.
  void finish(Description& description, bool is_strict);

 private:
  std::vector<Deviation> all_;
  std::set<std::tuple<DeviationKind, std::string, std::string>> known_;
};

}  // namespace kaustik
