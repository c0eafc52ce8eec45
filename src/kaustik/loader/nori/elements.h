#pragma once
#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "kaustik/loader/deviations.h"
#include "kaustik/scene/description.h"

namespace kaustik::nori {

/// The elements of a file as they are written: `family` is the tag of an object, and its properties
/// have the file's names. `name` stands for the file in messages. Throws Error(input).
std::shared_ptr<Object> read_elements(std::string text, const std::string& name);

/// In small letters, without '_'.
std::string plain_name(std::string_view name);

/// "bsdf 'microfacet' on line 12", for messages.
std::string label_of(const Object& element);

/// The properties of an element, which are taken one by one. Names are compared without regard to
/// case and to '_', since those of forks differ: ask for them in small letters.
class Given {
 public:
  using Names = std::initializer_list<std::string_view>;

  Given(const Object& element, Deviations& deviations)
      : element_(element), deviations_(deviations) {}
  /// Tells of those that nobody has taken.
  ~Given();
  Given(const Given&) = delete;
  Given& operator=(const Given&) = delete;

  const Object& element() const { return element_; }
  // The first of these that is given and of that type; none: nothing is.
  std::optional<double> number(Names names);
  std::optional<Rgb> colour(Names names);  ///< or a number, for all of it
  std::optional<Vec3d> point(Names names);
  std::optional<std::string> text(Names names);
  std::optional<Transform> transform(Names names);
  /// A whole number of at least `least`; `usual` where none is given. Throws Error(input).
  int64_t count(Names names, int64_t usual, int64_t least);
  /// What has a meaning in Nori and none here, and nobody misses.
  void skip(Names names);
  /// Of a property that was given; of the element otherwise.
  Place place_of(Names names) const;

 private:
  template <typename Convert>
  auto take(Names names, const Convert& convert);

  const Object& element_;
  Deviations& deviations_;
  std::set<const Property*> taken_;
};

}  // namespace kaustik::nori
