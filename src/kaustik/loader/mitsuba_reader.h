#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kaustik/loader/file_search.h"
#include "kaustik/loader/load_budget.h"
#include "kaustik/loader/mitsuba_definitions.h"
#include "kaustik/loader/mitsuba_element.h"
#include "kaustik/loader/mitsuba_references.h"
#include "kaustik/loader/mitsuba_upgrade.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/loader/xml_entities.h"

namespace kaustik::mitsuba {

/// What reading has cost.
struct LoadCounts {
  size_t files = 0;     ///< of the scene and of spectra, each as often as it was read
  size_t elements = 0;  ///< as often as each was made something of
};

/// Reads one scene and what it includes; used once.
class Reader {
 public:
  explicit Reader(const LoadOptions& options)
      : is_strict_(options.is_strict), definitions_(options, problems_) {}

  Description read_file(const std::string& path);
  Description read_text(std::string text, const std::string& name,
                        const std::filesystem::path& folder);
  /// So far; also after an error.
  const LoadCounts& counts() const { return counts_; }

 private:
  /// A file that is being read.
  struct Source {
    const XmlDocument& document;
    Version version;
    std::vector<std::filesystem::path> folders;  ///< where relative names are searched, in order
    std::filesystem::path own_folder;
  };
  /// An object that is being read, and where its properties and named children were given.
  struct Unfinished {
    std::shared_ptr<Object> object;
    std::map<std::string, Place> names;
  };

  /// Contents of a file that the scene is made of; counts against all limits.
  std::string text_of(const std::filesystem::path& path, const Place& where);
  /// A file without one has that of the file that includes it; `includer` is null for the scene.
  bool read_version(Source& source, const Version* includer = nullptr);
  Description finish(const std::shared_ptr<Object>& scene);
  std::shared_ptr<Object> read_scene(Source& source);

  std::optional<Element> ready(const pugi::xml_node& node, const Source& source);
  bool is_element(const pugi::xml_node& node, const Source& source);
  void refuse_children(const Element& element, const Source& source);
  /// Attributes of other programs are left out; all else as mitsuba::check_attributes().
  bool check_attributes(const Element& element, const AttributeRule& rule);

  void read_parts(const pugi::xml_node& node, Unfinished& parent, Source& source);
  void read_part(const Element& element, Unfinished& parent, Source& source);
  std::shared_ptr<Object> read_object(const Element& element, Source& source);
  void read_nested_object(const Element& element, Unfinished& parent, Source& source);
  void read_property(const Element& element, Unfinished& parent, Source& source);
  void read_blackbody(const Element& element, Unfinished& parent, Source& source);
  void read_transform(const Element& element, Unfinished& parent, Source& source);
  void read_animation(const Element& element, Unfinished& parent, Source& source);
  /// Of the operations in the element.
  Transform transform_of(const Element& element, const Source& source);
  void add_transform(const Element& element, const Transform& transform, Unfinished& parent,
                     const Source& source);
  void read_reference(const Element& element, Unfinished& parent, Source& source);
  void read_alias(const Element& element, Unfinished& parent, Source& source);
  void read_default(const Element& element, Unfinished& parent, Source& source);
  void read_search_folder(const Element& element, Unfinished& parent, Source& source);
  void read_include(const Element& element, Unfinished& parent, Source& source);
  void read_included(const std::filesystem::path& path, const Element& element, Unfinished& parent,
                     Source& includer);
  void read_included_object(const Element& root, const std::string& name, Unfinished& parent,
                            Source& source);
  /// Of a file that is included; each is read once, however often that is.
  const XmlDocument& included_document(const std::filesystem::path& path, const Place& place);
  /// Of a file that a <spectrum> names at that place; each is read once.
  const SpectralCurve& curve_of(const std::string& path, const Place& place);
  void report_unknown(const Element& element);
  /// Of an element that is left out, and of all that are in it.
  void leave_out_ids(const pugi::xml_node& node);
  /// Of a principled bsdf that has 'eta' as well, as lajolla's have.
  void leave_out_specular(Object& object);
  /// Reflectances and transmittances above 1.
  void scale_reflectances(Object& object);
  /// Of two lobes that together reflect more than arrives, in scenes before Mitsuba 2.
  void scale_sum_of_reflectances(Object& object);
  /// Before Mitsuba 2 a shape with a medium and no bsdf was a boundary of media alone.
  void open_old_shapes();
  /// What waits for references to be followed; and nested bsdfs counted in the order of the file,
  /// not by their names.
  void finish_old_bsdfs();
  /// Of several sensors Mitsuba 0.6 rendered the last one, and later versions the first.
  static void put_last_sensor_first(Object& scene);
  /// Scenes without an emitter were not dark before Mitsuba 2.
  void light_dark_scene(Object& scene);
  /// That light of the sky is physical here and not in Mitsuba, where that makes a difference.
  void tell_units_of_daylight(const Object& scene);
  /// `what` is told once, with how many there were.
  void leave_out(const std::string& what, const std::string& sentence, const Place& place);

  Value value_of(const Element& element, const std::string& name, const Source& source);
  Value spectrum_of(const Element& element, const Source& source);
  /// What a <spectrum> of one number means in a lamp.
  static Value light_of(const Value& spectrum, const Source& source);
  /// False, with the reason told, if the parent has such a part already.
  bool take_name(Unfinished& parent, const std::string& name, const Place& place);
  std::filesystem::path found(const std::string& file, const Source& source) const;
  /// The same; a file that is not there gives way to one with nearly that name, which is told.
  std::filesystem::path found_or_like(const Attribute& file, const Source& source);
  /// For files that are named in others than those of the scene; quotes nothing of them.
  std::optional<std::filesystem::path> found_beside(const std::string& name,
                                                    const std::filesystem::path& folder,
                                                    const Place& place);
  /// For the entities of a file in that folder: they are files beside it.
  EntityRules entity_rules(const std::filesystem::path& folder);
  /// Throws Error, as all that entity_rules() makes does.
  EntityFile entity_file(const std::string& name, const std::filesystem::path& folder,
                         const Place& where);
  /// Whether the file is one of those that are being read.
  bool is_open(const std::filesystem::path& path) const;

  struct LeftOut {
    std::string sentence;
    Place first;
    int count = 0;
  };

  struct OldBsdf {
    std::shared_ptr<Object> bsdf;
    std::string written_type;
    Version version;
  };

  bool is_strict_;
  LoadCounts counts_;
  Problems problems_;
  Definitions definitions_;
  References references_;
  FileSearch file_search_;
  LoadBudget budget_;
  std::map<std::filesystem::path, std::unique_ptr<XmlDocument>> documents_;  ///< by identity
  std::map<std::string, SpectralCurve> curves_;                              ///< by path
  std::map<std::string, LeftOut> left_out_;                                  ///< by what it is
  std::set<std::string> sources_;                                            ///< see Description
  std::set<const Object*> old_obj_shapes_;            ///< that take materials from their files
  std::vector<std::filesystem::path> scene_folders_;  ///< where names in the scene are searched
  std::vector<std::filesystem::path> open_files_;     ///< the outermost first
  size_t included_files_ = 0;
  size_t read_bytes_ = 0;
  size_t entity_bytes_left_ = EntityRules::most_bytes;
  std::vector<std::shared_ptr<Object>> old_shapes_;  ///< of files before Mitsuba 2
  std::vector<OldBsdf> old_bsdfs_;                   ///< of files before Mitsuba 2
  std::vector<const Object*> daylights_;             ///< whose units the file does not tell
  int depth_ = 0;
  Version version_ = {0, 0, 0};  ///< of the scene
  bool incomplete_ = false;      ///< a part of the scene could not be read at all
};

}  // namespace kaustik::mitsuba
