#pragma once
// Carries out a file's directives, one after the other.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "kaustik/loader/pbrt/world.h"

namespace kaustik::pbrt {

class Directives {
 public:
  Directives(SceneFiles& files, Deviations& deviations);

  static bool knows(std::string_view word);

  /// Throws Error(input).
  void run(const SourceText& text);
  /// Makes the scene of all that was read; `place`: of the file.
  void finish(const Place& place, Description& description);

 private:
  /// Who asks a tokenizer for what belongs to a directive.
  struct Call {
    Tokenizer& tokens;
    const Token& word;
    Place place() const { return tokens.place_of(word); }
  };
  using Handler = void (Directives::*)(const Call&);
  static const std::map<std::string_view, Handler>& handlers();

  void run_one(const Call& call);

  // Transforms.
  void identity(const Call& call);
  void translate(const Call& call);
  void scale(const Call& call);
  void rotate(const Call& call);
  void look_at(const Call& call);
  void transform(const Call& call);
  void concat_transform(const Call& call);
  void coordinate_system(const Call& call);
  void coord_sys_transform(const Call& call);
  void active_transform(const Call& call);
  void transform_times(const Call& call);
  // The graphics state.
  void attribute_begin(const Call& call);
  void attribute_end(const Call& call);
  void transform_begin(const Call& call);
  void transform_end(const Call& call);
  void attribute(const Call& call);
  void colour_space(const Call& call);
  void reverse_orientation(const Call& call);
  // What stands before the world.
  void camera(const Call& call);
  void film(const Call& call);
  void sampler(const Call& call);
  void integrator(const Call& call);
  void pixel_filter(const Call& call);
  void accelerator(const Call& call);
  void option(const Call& call);
  void world_begin(const Call& call);
  void world_end(const Call& call);
  // Objects.
  void shape(const Call& call);
  void light_source(const Call& call);
  void area_light_source(const Call& call);
  void material(const Call& call);
  void make_named_material(const Call& call);
  void named_material(const Call& call);
  void texture(const Call& call);
  void make_named_medium(const Call& call);
  void medium_interface(const Call& call);
  void object_begin(const Call& call);
  void object_end(const Call& call);
  void object_instance(const Call& call);
  void include(const Call& call);
  void import(const Call& call);

  /// A string in quotes, which has to come next.
  std::string quoted(const Call& call, const char* what);
  ParameterList parameters(const Call& call);
  Setting setting(const Call& call);
  void read_numbers(const Call& call, double* numbers, size_t count);
  /// To the transforms that ActiveTransform names; `replaces`: instead of what is there.
  void apply(const Transform& change, bool replaces = false);
  void push(const Call& call, bool is_transform_only);
  void pop(const Call& call, bool is_transform_only);

  struct Saved {
    GraphicsState state;
    bool is_transform_only = false;
    Place place;
  };

  SceneFiles& files_;
  Deviations& deviations_;
  World world_;
  GraphicsState state_;
  std::vector<Saved> saved_;
  std::map<std::string, MovingTransform> coordinate_systems_;
  ViewSettings view_;
  std::string camera_medium_;
};

/// The matrix of rows; where it leaves no volume, one that collapses space. Throws Error(input).
Transform transform_of(const double (&rows)[4][4], const Place& place);
/// From the world to a camera that looks from `eye` toward `target`, +x to the right, +y up and +z
/// ahead. Throws Error(input) where no direction is left.
Transform camera_looking(const Vec3d& eye, const Vec3d& target, const Vec3d& up,
                         const Place& place);

}  // namespace kaustik::pbrt
