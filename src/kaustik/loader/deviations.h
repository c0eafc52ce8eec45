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
  /// sentence without a full stop ("hair is rendered as a rough dielectric"), `remedy` what the
  /// user can do about it ("did you mean 'hair'?"); "": nothing in particular.
  void add(DeviationKind kind, std::string object, std::string what, Place place,
           std::string remedy = {});

  void approximated(std::string object, std::string what, Place place, std::string remedy = {}) {
    add(DeviationKind::approximated, std::move(object), std::move(what), std::move(place),
        std::move(remedy));
  }
  void ignored(std::string object, std::string what, Place place, std::string remedy = {}) {
    add(DeviationKind::ignored, std::move(object), std::move(what), std::move(place),
        std::move(remedy));
  }
  void missing(std::string object, std::string what, Place place, std::string remedy = {}) {
    add(DeviationKind::missing, std::move(object), std::move(what), std::move(place),
        std::move(remedy));
  }

  /// Puts them into the description, each with its remedy. Throws Error(input) with one problem for
  /// each if the reader is strict and there are any.
  void finish(Description& description, bool is_strict);

 private:
  struct Told {
    Deviation deviation;
    std::string remedy;
  };
  std::vector<Told> all_;
  std::set<std::tuple<DeviationKind, std::string, std::string>> known_;
};

}  // namespace kaustik
