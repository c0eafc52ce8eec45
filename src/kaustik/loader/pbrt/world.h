#pragma once
// All that a scene of pbrt holds, collected while its files are read, and made into objects in the
// end, when every name is known.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "kaustik/loader/pbrt/camera.h"
#include "kaustik/loader/pbrt/graphics_state.h"
#include "kaustik/loader/pbrt/media.h"
#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {

class World {
 public:
  World(SceneFiles& files, Deviations& deviations);

  /// What follows is of pbrt-v3 or older, which means other things by words that v4 has, too.
  void become_old();

  void define_texture(const std::string& name, bool is_float, const std::string& type,
                      ParameterList list, const GraphicsState& state);
  /// Its index.
  size_t define_material(const std::string& name, const std::string& type, ParameterList list,
                         const GraphicsState& state);
  /// By a name that may be defined later.
  MaterialReference material_named(const std::string& name, const Place& place) const;
  void define_medium(const std::string& name, const std::string& type, ParameterList list,
                     const GraphicsState& state);
  void add_light(const std::string& type, ParameterList list, const GraphicsState& state);
  /// What shapes that follow shine as; null: they do not.
  std::shared_ptr<const AreaLight> area_light(const std::string& type, ParameterList list,
                                              const GraphicsState& state);
  void add_shape(const std::string& type, ParameterList list, const GraphicsState& state);

  void begin_object(const std::string& name, const Place& place);
  void end_object(const Place& place);
  void add_instance(const std::string& name, const Place& place, const GraphicsState& state);

  /// The scene. `camera_medium`: the name of the medium around the camera.
  void finish(const ViewSettings& view, const std::string& camera_medium, Description& description);

 private:
  /// A shape whose material, medium or alpha may not be known yet.
  struct PendingShape {
    std::shared_ptr<Object> shape;
    std::string object;  ///< "shape 'sphere'"
    MaterialReference material;
    std::shared_ptr<const AreaLight> light;
    MediumSides media;
    ParameterList alpha;  ///< that parameter alone, or none
    Owner owner;
    bool is_flipped = false;
    size_t lamps = 1;                   ///< ShapeTools::lamps
    std::unique_ptr<MeshParts> curves;  ///< instead of a shape, in the world
  };
  using Shapes = std::vector<PendingShape>;

  struct PendingInstance {
    std::string group;
    Transform to_world;
    Place place;
  };

  Owner owner(std::string object, const GraphicsState& state) const;
  void add_defaults(ParameterList& list, const GraphicsState& state, AttributeKind kind);
  Transform resting(const MovingTransform& transform, const std::string& object,
                    const Place& place);
  bool may_be_textured(const MaterialReference& material) const;
  void add_curve_of(const ShapeTools& tools, PendingShape pending);
  Shapes& open_shapes() { return open_object_ ? *open_object_ : shapes_; }

  std::shared_ptr<Object> finished(PendingShape& pending, bool is_in_group);
  void give_light(PendingShape& pending, const MadeMaterial& material, bool is_in_group,
                  bool is_hidden);
  std::shared_ptr<Object> masked(const std::shared_ptr<Object>& bsdf, const Input& alpha);
  std::shared_ptr<Object> emitter_of(const PendingShape& pending);
  /// Puts the uv of its textures' mapping in place of the shape's own, or tells why not.
  void lay_textures(const PendingShape& pending, const MappingSet& mappings, bool is_in_group);
  void give_media(PendingShape& pending, const MadeMaterial& material);
  void finish_instances(Object& scene);

  SceneFiles& files_;
  Deviations& deviations_;
  Spectra spectra_;
  Textures textures_;
  Ids ids_;
  Materials materials_;
  Media media_;
  bool is_old_ = false;  ///< become_old()
  size_t sequence_ = 1;  ///< how many things were defined
  std::vector<bool> textured_materials_;
  std::map<std::string, bool> textured_names_;
  Shapes shapes_;
  std::map<std::string, Shapes> objects_;
  Shapes* open_object_ = nullptr;
  std::vector<PendingInstance> instances_;
  struct PendingLight {
    std::shared_ptr<Object> emitter;
    std::string medium;
    Place place;
  };
  std::vector<PendingLight> lights_;
  std::set<std::string> skies_;  ///< sky_key() of those with portals
  std::map<const AreaLight*, std::shared_ptr<Object>> emitters_;
  std::map<std::tuple<const Object*, const Object*, double>, std::shared_ptr<Object>> masks_;
};

}  // namespace kaustik::pbrt
