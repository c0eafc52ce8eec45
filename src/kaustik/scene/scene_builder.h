#pragma once
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "kaustik/image/picture_reader.h"
#include "kaustik/scene/part_keys.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// Turns a description into the parts of a scene; collects problems on the way and throws them
/// together. One builder serves one scene. What `previous`, null: none, has of it already is taken
/// from there.
class SceneBuilder {
 public:
  explicit SceneBuilder(int64_t texture_memory_bytes, const Scene* previous = nullptr,
                        bool is_strict = false)
      : previous_(previous), pictures_(texture_memory_bytes), is_strict_(is_strict) {}
  /// Before build(): the camera is to see no light itself, whatever the lights say.
  void hide_lights() { hides_lights_ = true; }
  Scene::Parts build(const Object& scene);

 private:
  /// A shape with what the file says of its surface.
  struct BuiltShape {
    std::shared_ptr<const Shape> shape;
    const Object* object = nullptr;
    Surface surface;
  };
  struct PendingLight {
    const Object* object = nullptr;
    std::shared_ptr<const Shape> shape;  ///< of area lights
    int shape_index = -1;
  };

  void add_top_level(const Object& object);
  void find_emitters_of_shapes(const Object& scene);
  /// Whether it stands at the top of the scene for shapes to refer to it.
  bool is_for_shapes(const Object& emitter);
  void add_shape(const Object& object);
  void add_instance(const Object& object);
  uint32_t group_index(const std::shared_ptr<Object>& group);
  std::optional<BuiltShape> make_shape(const Object& object);
  /// Whether shapes of the type take a texture, for heights.
  static bool takes_heights(const TypeInfo& shape);
  /// The shape, with the heights that a texture in it gives as the buffer that stands for them;
  /// nothing if the texture is wrong, which was told.
  std::optional<Object> with_heights(const Object& shape, const TypeInfo& info);
  // `on`: the shape that a bsdf or a texture lies on, for textures that ask it; null: none, it is
  // only checked.
  std::shared_ptr<const Bsdf> make_bsdf(const std::shared_ptr<Object>& object,
                                        const BuiltShape* on);
  std::shared_ptr<const Bsdf> create_bsdf(const Object& object, const BuiltShape* on);
  std::shared_ptr<const Texture> make_texture(const std::shared_ptr<Object>& object,
                                              const BuiltShape* on);
  std::shared_ptr<const Texture> create_texture(const Object& object, const BuiltShape* on);
  /// Whether a texture in it, or it itself, asks the shape.
  bool asks_surface(const Object& object);
  /// What is made of an object: one for all shapes, or for each its own.
  using MadeOn = std::pair<const Object*, const Shape*>;
  MadeOn made_on(const Object& object, const BuiltShape* on);
  uint64_t key_on(const Object& object, const BuiltShape* on);
  /// Null where there is no shape. Where it has no such attribute, zero, with a warning; in a scene
  /// that is read strictly throws Error(input) at `place`.
  std::shared_ptr<const SurfaceAttribute> attribute_of(const BuiltShape* on,
                                                       const std::string& name, const Place& place);
  using Textures = std::map<std::string, std::shared_ptr<const Texture>, std::less<>>;
  /// The textures in an object, by the parameters that they stand for; none if one is wrong.
  std::optional<Textures> textures_of(const Object& object, const TypeInfo& info,
                                      const BuiltShape* on);
  std::shared_ptr<const Medium> make_medium(const std::shared_ptr<Object>& given);
  /// The medium as one that does not glow, which is told.
  std::shared_ptr<Object> without_emission(const std::shared_ptr<Object>& medium);
  std::shared_ptr<const PhaseFunction> make_phase_function(const Object& object, int level = 0);
  /// An isotropic phase function, or those in it, for one that nobody knows; warns.
  std::shared_ptr<const PhaseFunction> phase_instead_of(const Object& object, int level);
  /// Of `mixturephase` of Mitsuba 0.6; null, with a problem told: the weights or a phase function
  /// are wrong.
  std::shared_ptr<const PhaseFunction> mixture_of_phases(const Object& mixture, int level);
  /// With the value of a constant volume as `weight`; a grid is left out.
  Object with_constant_weight(const Object& phase);
  /// The volume that will do for one that nobody knows: the one in it. Null: none, which is told.
  const std::shared_ptr<Object>* volume_instead_of(const std::shared_ptr<Object>& volume);
  std::shared_ptr<const Volume> make_volume(const std::shared_ptr<Object>& object);
  using Volumes = std::map<std::string, MediumInputs::GivenVolume, std::less<>>;
  /// The volumes in an object, by the parameters that they stand for; none if one is wrong.
  std::optional<Volumes> volumes_of(const Object& object, const TypeInfo& info);
  /// The one medium among the children of a sensor or an emitter; null if there is none.
  std::shared_ptr<const Medium> medium_of(const Object& object);
  /// The surface's interior and exterior.
  void read_media(const Object& shape, Surface& surface);
  /// The first one is the scene's camera; `shape`: that it belongs to, −1: none.
  void add_sensor(const Object& object, int shape);
  void make_sensor(const Object& object);
  /// Its size is that of the camera's list, and no filter mixes pixels.
  void make_film_of_pixels_apart(const Object& film);
  /// Null: there is none. A second one is told.
  const Object* only_child(const Object& object, const std::string& family);
  /// What the camera belongs to, or looks at; null: nothing, or what is wrong with it was told.
  std::shared_ptr<const Shape> shape_of_sensor(const Object& object, const CameraType& type);
  Bounds3f bounds_of_shapes() const;
  /// Whether its only texture is a spectral response, which means nothing here.
  bool leaves_out_response(const Object& sensor);
  /// A specfilm without the bands of wavelengths that it names.
  Object without_bands(const Object& film, const TypeInfo& info);
  void read_film(const Object& object);
  void read_filter(const Object& object);
  void read_sampler(const Object& object);
  void make_lights();
  void make_light(const LightType& type, const PendingLight& pending, const Arguments& arguments);
  /// Reads the files of all shapes side by side, for shape_of(); what is wrong with them is told
  /// there.
  void read_meshes(const Object& scene);
  /// Makes what the description of a shape, a texture, a bsdf or a volume says, or finds it in the
  /// scene before. Throws Error.
  std::shared_ptr<const Shape> shape_of(const Object& object, const ShapeType& type,
                                        const Arguments& arguments);
  uint64_t shape_key(const Object& object, const ShapeType& type);
  /// BuiltParts::world.
  uint64_t world_key(const Object& scene);
  std::shared_ptr<const Texture> texture_of(const Object& object, const TextureType& type,
                                            const TextureInputs& inputs, const BuiltShape* on);
  std::shared_ptr<const Bsdf> bsdf_of(const Object& object, const BsdfType& type,
                                      const BsdfInputs& inputs, const BuiltShape* on);
  std::shared_ptr<const Volume> volume_of(const Object& object, const VolumeType& type,
                                          const Arguments& arguments);
  /// Of the texture in an emitter, of which no type takes more than one; null: it has none.
  std::shared_ptr<const EmissionPattern> emission_pattern_of(const LightType& type,
                                                             const PendingLight& pending,
                                                             const Arguments& arguments);
  Geometry make_geometry();
  /// World shapes that are solid bodies, those of the highest priority first.
  std::vector<uint32_t> find_bodies();
  /// Appends what covers the parts of bodies.
  void add_body_parts(std::span<const BodyPart> parts, std::vector<Surface>& surfaces);
  /// Of the part of a body's surface that lies in another body.
  std::shared_ptr<const Bsdf> bsdf_within(const BuiltShape& shape, const Object& around);

  /// The value of a spectrum; nothing if it is wrong, which has been told.
  const std::optional<Value>& value_of_spectrum(const Object& spectrum);
  /// The properties of an object, and the spectra that it holds.
  std::vector<Property> properties_of(const TypeInfo& info, const Object& object);
  /// Of a texture at a parameter that takes none: nothing if it is no number and no colour, or if
  /// the texture is wrong or left out, which is told.
  std::optional<Value> mean_instead_of(const TypeInfo& info, const Child& texture);
  /// A texture for which no parameter is, in an object of a scene that is not read strictly: what
  /// becomes of it is told here or by mean_instead_of(). False for a slip of the pen.
  bool leaves_out_texture(const Object& object, const TypeInfo& info, const Child& texture);
  /// The texture in it, or it itself, that nobody knows and that it cannot do without; null: none.
  const Object* foreign_texture_in(const Object& texture) const;
  /// The same of a texture that a bsdf is made for, such as the heights of a relief.
  const Object* foreign_texture_of(const Object& bsdf, const TypeInfo& info) const;
  /// With numbers beyond their ranges taken to the ends, where the table allows it.
  std::vector<Property> within_ranges(const TypeInfo& info, std::vector<Property> properties);
  /// Arguments of an object, with warnings for what is accepted without effect.
  Arguments arguments_of(const TypeInfo& info, const Object& object);
  void refuse_children(const Object& object, const std::vector<std::string>& allowed_families);
  void unknown_type(const Object& object, const std::vector<std::string>& valid);
  /// Whether a type that no table has is another program's, rather than a slip of the pen; none is
  /// where the scene is read strictly.
  bool is_foreign(const Object& object, const std::vector<std::string>& valid) const;
  /// A problem: remedy_for_type_to_come() says what to do.
  void not_here_yet(const Object& object);
  /// Warns, once for each object, that Kaustik does not know its type, and what follows.
  void leave_out(const Object& object, const std::string& consequence);
  /// A shape of which to_world leaves nothing; an error where the scene is read strictly.
  void leave_out_flat(const Object& shape);
  /// Whether a file that an object names is not there; tells so, with what that leads to. Never, if
  /// strict: then it is an error where it is read.
  bool lacks_file(const Object& object, const TypeInfo& info, const std::string& consequence);
  /// Of a texture, an emitter or a volume that lacks its file; null: it does not.
  std::shared_ptr<Object> stand_in_for_file(const Object& object, const TypeInfo& info);
  /// A problem where the scene is read strictly, else a warning.
  void told_unless_strict(const std::string& message, const std::string& remedy,
                          const Place& place);
  /// Matt, of a reflectance of one half …
  std::shared_ptr<const Bsdf> usual_bsdf();
  /// … and of none.
  std::shared_ptr<const Bsdf> black_bsdf();
  /// The bsdf in one that nobody knows, or a matt one of its colour; warns.
  std::shared_ptr<const Bsdf> bsdf_instead_of(const Object& object, const BuiltShape* on);
  /// An emitter that shines with what one of an unknown type has; null, with the reason told: there
  /// is none.
  const Object* emitter_instead_of(const PendingLight& pending);
  /// Of the mesh file that a shape of another program names; null: it names none.
  const Object* shape_instead_of(const Object& shape);
  /// A pinhole for Mitsuba 0.6's camera with radial distortion; warns. Null: it is none.
  const Object* sensor_instead_of(const Object& sensor);
  /// Makes Mitsuba's camera of scenes that have none the sensor; warns. False, with the problem
  /// told, where there is nothing to see.
  bool place_camera(const Place& place);
  /// The same for what changes the light of no picture: unless the scene is read strictly, a
  /// warning that another type stands for it.
  void use_instead(const Object& object, const std::vector<std::string>& valid,
                   const std::string& instead);
  /// A parameter of `object` ("film 'hdrfilm'") that has no effect; told once.
  void ignore(const Property& property, const std::string& object);
  /// Runs `body` and turns what it throws into problems; those without a place get `place`, those
  /// in another file tell that it was named there.
  void collecting(const Place& place, const std::function<void()>& body);
  /// Where an object names its file or gives its buffer; without one its own place.
  static Place source_place(const Arguments& arguments);

  /// Of the scene before; empty where there is none.
  const BuiltParts& before() const;

  const Scene* previous_;
  PartKeys keys_;
  BuiltParts built_;
  BuildCounts counts_;
  Problems problems_;
  PictureReader pictures_;
  std::vector<std::string> warnings_;
  bool is_strict_;  ///< Description::is_strict
  UnknownParameters unknown_;
  std::set<const Object*> left_out_;            ///< of types that nobody knows
  std::map<std::string, std::string> ignored_;  ///< without effect: what it is, and its text
  std::set<std::string> remarks_reported_;
  std::set<std::string> emitters_of_shapes_;  ///< their ids
  std::vector<BuiltShape> shapes_;
  std::vector<std::vector<BuiltShape>> groups_;
  std::map<const Object*, uint32_t> group_of_;
  struct ReadMesh {
    std::shared_ptr<const Shape> shape;
    std::exception_ptr error;
  };
  std::map<const Object*, ReadMesh> read_meshes_;  ///< that were not asked for yet
  std::vector<Instance> instances_;
  std::vector<PendingLight> pending_lights_;
  std::map<const Object*, bool> asks_surface_;
  std::map<MadeOn, std::shared_ptr<const Bsdf>> bsdfs_;
  std::map<MadeOn, std::shared_ptr<const Texture>> textures_;
  std::map<const Object*, std::shared_ptr<const Medium>> media_;
  std::vector<std::shared_ptr<const Object>> bordering_;  ///< bsdfs of parts of bodies
  std::vector<std::shared_ptr<const Object>> stand_ins_;  ///< for what the scene lacks
  std::map<const Object*, std::optional<Value>> spectra_;
  std::map<const Object*, std::shared_ptr<const Volume>> volumes_;
  std::vector<std::shared_ptr<const Light>> lights_;
  std::vector<std::shared_ptr<const Medium>> light_media_;
  std::vector<bool> hidden_lights_;
  std::vector<std::string> light_names_;
  bool hides_lights_ = false;
  std::shared_ptr<const Medium> camera_medium_;
  Bounds3f bounds_;
  FilmSettings film_;
  std::unique_ptr<Camera> camera_;
  const Object* sensor_ = nullptr;
  int sensor_shape_ = -1;  ///< that it belongs to; −1: none
};

}  // namespace kaustik
