#pragma once
// Lists of parameters: "float radius" 0.5 "rgb L" [ 1 1 1 ] …

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/vec.h"
#include "kaustik/loader/deviations.h"
#include "kaustik/loader/pbrt/tokenizer.h"

namespace kaustik::pbrt {

/// One parameter with its values. Type and name are those of pbrt-v4, whatever the file spells.
struct Parameter {
  std::string_view type, name;
  Place place;
  /// Values of one kind: coordinates and normals as floats, integers, other numbers as doubles.
  std::shared_ptr<std::vector<float>> floats;
  std::shared_ptr<std::vector<int32_t>> integers;
  std::vector<double> numbers;
  std::vector<std::string> texts;
  std::vector<bool> flags;
  mutable bool is_used = false;

  size_t number_count() const {
    return floats ? floats->size() : integers ? integers->size() : numbers.size();
  }
  double number(size_t i) const {
    return floats ? double((*floats)[i]) : integers ? double((*integers)[i]) : numbers[i];
  }
};

/// The parameters of one object. Names are compared without case, since versions differ in it;
/// whoever asks for one marks it as used.
class ParameterList {
 public:
  ParameterList() = default;
  explicit ParameterList(Place place) : place_(std::move(place)) {}

  /// Reads what follows a directive, up to the next one. Throws Error(input).
  static ParameterList read(Tokenizer& tokens, const Place& place);

  /// Parameters of the directive Attribute: they count where the list has none of the name.
  void add_defaults(const ParameterList& others);

  const Place& place() const { return place_; }
  bool empty() const { return all_.empty(); }
  std::vector<Parameter>& all() { return all_; }
  const std::vector<Parameter>& all() const { return all_; }

  /// Null: there is none. Of several types, any of these; none given: any type.
  const Parameter* find(std::string_view name,
                        std::initializer_list<std::string_view> types = {}) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }

  std::optional<double> number(std::string_view name) const;
  double number(std::string_view name, double otherwise) const {
    return number(name).value_or(otherwise);
  }
  /// Rounded, within what an int can be.
  int integer(std::string_view name, int otherwise) const;
  bool flag(std::string_view name, bool otherwise) const;
  std::string text(std::string_view name, const std::string& otherwise = {}) const;
  std::optional<Vec3d> point(std::string_view name) const;
  /// Of a list of numbers; empty: there is none.
  std::vector<double> numbers(std::string_view name) const;
  Place place_of(std::string_view name) const;

  /// Marks as used without asking.
  void accept(std::initializer_list<std::string_view> names) const;
  /// Tells those of an object that nobody has asked for.
  void tell_unused(const std::string& object, Deviations& deviations) const;
  /// Memory that its values take.
  size_t bytes() const;

 private:
  Place place_;
  std::vector<Parameter> all_;
};

bool is_same_name(std::string_view a, std::string_view b);

}  // namespace kaustik::pbrt
