#include "kaustik/loader/mitsuba_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/mitsuba_medium.h"
#include "kaustik/loader/mitsuba_sky.h"
#include "kaustik/loader/mitsuba_tags.h"
#include "kaustik/loader/obj_materials.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::mitsuba {
namespace {

namespace fs = std::filesystem;

/// What an element becomes takes at most so much, beside what its attributes hold: an object or a
/// property, that its parent holds it, and who refers to it.
constexpr size_t bytes_per_element = 500, bytes_per_attribute = 50;

}  // namespace

bool Reader::read_version(Source& source, const Version* includer) {
  const pugi::xml_node root = source.document.root();
  const pugi::xml_attribute version = root.attribute("version");
  // Any file may be named, and one that is no part of a scene is not to be quoted.
  const bool looks_like_part = std::string_view(root.name()) == "scene" || root.attribute("type");
  if (!version && !is_strict_ && includer && looks_like_part) {
    source.version = *includer;
    leave_out("version of a part",
              fmt::format("<{}> lacks its version: it is read as one of the file that includes it",
                          root.name()),
              source.document.place(root));
    return true;
  }
  if (!version && !is_strict_ && std::string_view(root.name()) == "scene") {
    // As Mitsuba 0.6 took it.
    source.version = {0, 2, 0};
    leave_out("version",
              fmt::format("<{}> lacks its version: it is read as one of Mitsuba 0.2", root.name()),
              source.document.place(root));
    return true;
  }
  if (!version) {
    // A file that is no scene may have such a root, too: nothing of it is quoted.
    Place place = source.document.place(root);
    if (std::string_view(root.name()) != "scene") place.column = 0;
    problems_.add(fmt::format("<{}> lacks its version", root.name()),
                  fmt::format("write <{} version=\"3.0.0\">, or \"0.6.0\" for a scene of "
                              "Mitsuba 0.6",
                              root.name()),
                  place);
    return false;
  }
  try {
    source.version = parse_version(version.value());
    return true;
  } catch (const BadValue& bad) {
    problems_.add(bad.what(), bad.remedy, source.document.place_of_value(version));
    return false;
  }
}

std::shared_ptr<Object> Reader::read_scene(Source& source) {
  const auto element = ready(source.document.root(), source);
  if (!element) return nullptr;
  if (element->tag != "scene") {
    problems_.add(fmt::format("the root element is <{}>", element->tag),
                  "a scene file starts with <scene version=\"3.0.0\">", element->place);
    return nullptr;
  }
  return read_object(*element, source);
}

Description Reader::finish(const std::shared_ptr<Object>& scene) {
  if (scene && !incomplete_) {
    references_.resolve(scene, problems_);
    if (problems_.empty()) open_old_shapes();
    if (problems_.empty()) finish_old_bsdfs();
    if (problems_.empty()) tell_units_of_daylight(*scene);
    const bool is_old = version_ < first_with_snake_case;
    if (problems_.empty() && is_old) put_last_sensor_first(*scene);
    // What is left out may have used them.
    if (left_out_.empty()) definitions_.report_unused(problems_);
    if (problems_.empty() && is_old) light_dark_scene(*scene);
  }
  problems_.throw_if_any();
  Description description{.scene = scene, .sources = {sources_.begin(), sources_.end()}};
  description.is_strict = is_strict_;
  use_obj_materials(description, old_obj_shapes_,
                    [this](const std::string& name, const fs::path& folder, const Place& place) {
                      return found_beside(name, folder, place);
                    });
  for (const auto& [what, left_out] : left_out_)
    description.warnings.push_back(fmt::format(
        "{}: {}{}", kaustik::text_of(left_out.first), left_out.sentence,
        left_out.count > 1 ? fmt::format(", and {} more like it", left_out.count - 1) : ""));
  return description;
}

std::optional<Element> Reader::ready(const pugi::xml_node& node, const Source& source) {
  ++counts_.elements;
  const XmlDocument& document = source.document;
  Element element = {upgraded_tag(node.name(), source.version), node, document.place(node), {}};
  bool sound = true;
  size_t bytes = bytes_per_element;
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    Attribute result = {attribute.name(),
                        {},
                        attribute.value(),
                        document.place_of_name(attribute),
                        document.place_of_value(attribute)};
    try {
      result.value = definitions_.replace(result.written);
    } catch (const BadValue& bad) {
      problems_.add(bad.what(), bad.remedy, result.place);
      sound = false;
    }
    bytes += bytes_per_attribute + result.value.size();
    element.attributes.push_back(std::move(result));
  }
  budget_.spend(bytes, element.place);
  if (!sound) return std::nullopt;
  return element;
}

bool Reader::is_element(const pugi::xml_node& node, const Source& source) {
  if (node.type() == pugi::node_pcdata && !is_strict_) {
    const std::string_view text = trimmed(node.value());
    if (text.starts_with('&') && text.ends_with(';'))
      leave_out("entity", "an entity that no DOCTYPE declares is left out",
                source.document.place(node));
    else
      leave_out("text", "text between the elements is left out", source.document.place(node));
  } else if (node.type() == pugi::node_pcdata) {
    problems_.add(fmt::format("text between the elements: {}", in_quotes(trimmed(node.value()))),
                  "values stand in attributes, as in <float name=\"radius\" value=\"1\"/>",
                  source.document.place(node));
  }
  return node.type() == pugi::node_element;
}

void Reader::refuse_children(const Element& element, const Source& source) {
  for (const pugi::xml_node& child : element.node.children())
    if (is_element(child, source))
      problems_.add(fmt::format("<{}> cannot stand in <{}>", child.name(), element.tag),
                    fmt::format("end <{}> with '/>'", element.tag), source.document.place(child));
}

bool Reader::check_attributes(const Element& element, const AttributeRule& rule) {
  return mitsuba::check_attributes(element, rule, problems_, [&](const Attribute& attribute) {
    if (is_strict_) return false;
    leave_out("attribute " + element.tag + " " + attribute.name,
              fmt::format("Kaustik does not know the attribute {} of <{}>: it is left out",
                          in_quotes(attribute.name), element.tag),
              attribute.name_place);
    return true;
  });
}

void Reader::read_parts(const pugi::xml_node& node, Unfinished& parent, Source& source) {
  for (const pugi::xml_node& child : node.children())
    if (is_element(child, source)) {
      if (const auto element = ready(child, source))
        read_part(*element, parent, source);
      else if (!is_in(property_tags(), child.name()))
        incomplete_ = true;
    }
}

void Reader::read_part(const Element& element, Unfinished& parent, Source& source) {
  using Read = void (Reader::*)(const Element&, Unfinished&, Source&);
  static const std::map<std::string_view, Read> others = {
      {"transform", &Reader::read_transform}, {"ref", &Reader::read_reference},
      {"alias", &Reader::read_alias},         {"default", &Reader::read_default},
      {"path", &Reader::read_search_folder},  {"include", &Reader::read_include},
      {"animation", &Reader::read_animation}, {"blackbody", &Reader::read_blackbody}};
  const bool is_srgb = element.tag == "srgb" && source.version < Version{2, 0, 0};
  const bool typed_spectrum = element.tag == "spectrum" && element.find("type");
  if (element.tag == "background" && !is_strict_) {  // of torrey
    Element light = element;
    light.tag = "emitter";
    if (!light.find("type"))
      light.attributes.push_back({"type", "constant", "constant", element.place, element.place});
    read_nested_object(light, parent, source);
    return;
  }
  if (const auto other = others.find(element.tag); other != others.end())
    (this->*other->second)(element, parent, source);
  else if (typed_spectrum || is_in(object_tags(), element.tag))
    read_nested_object(element, parent, source);
  else if (is_srgb || is_in(property_tags(), element.tag))
    read_property(element, parent, source);
  else
    report_unknown(element);
}

void Reader::leave_out_ids(const pugi::xml_node& node) {
  std::vector<pugi::xml_node> pending = {node};
  while (!pending.empty()) {
    const pugi::xml_node at = pending.back();
    pending.pop_back();
    if (const pugi::xml_attribute id = at.attribute("id"); id && *id.value() != '\0')
      references_.leave_out(id.value());
    for (const pugi::xml_node& child : at.children()) pending.push_back(child);
  }
}

void Reader::report_unknown(const Element& element) {
  // Other renderers have elements of their own. What looks like one of ours was meant to be one.
  if (element.tag == "subsurface" && !is_strict_) {
    leave_out_ids(element.node);
    leave_out("subsurface",
              "subsurface scattering comes later: <subsurface> is left out, the surface is what "
              "its bsdf says",
              element.place);
    return;
  }
  const bool is_ours = is_in(transform_tags(), element.tag) ||
                       upgraded_tag(element.tag, {0, 0, 0}) != element.tag ||
                       suggestion(element.tag, part_tags()).starts_with("did you mean");
  if (!is_strict_ && !is_ours) {
    leave_out_ids(element.node);
    leave_out(element.tag, fmt::format("Kaustik does not know <{}>: it is left out", element.tag),
              element.place);
    return;
  }
  incomplete_ = true;  // its ids and definitions are unknown
  if (is_in(transform_tags(), element.tag)) {
    problems_.add(
        fmt::format("<{}> outside of a <transform>", element.tag),
        fmt::format("write <transform name=\"to_world\"><{} …/></transform>", element.tag),
        element.place);
    return;
  }
  problems_.add(fmt::format("unknown element <{}>", element.tag),
                suggestion(element.tag, part_tags()), element.place);
}

void Reader::leave_out(const std::string& what, const std::string& sentence, const Place& place) {
  ++left_out_.try_emplace(what, LeftOut{sentence, place, 0}).first->second.count;
}

bool Reader::take_name(Unfinished& parent, const std::string& name, const Place& place) {
  if (name.empty()) return true;
  const auto [first, is_new] = parent.names.try_emplace(name, place);
  if (!is_new)
    problems_.add(fmt::format("{} is given twice", in_quotes(name)),
                  fmt::format("keep one; the first is at {}:{}:{}", *first->second.file,
                              first->second.line, first->second.column),
                  place);
  return is_new;
}

std::shared_ptr<Object> Reader::read_object(const Element& element, Source& source) {
  const bool is_root = element.node == source.document.root();
  const bool is_scene = element.tag == "scene";
  AttributeRule rule = {{"type"}, {"id", "name", "version"}};
  if (is_scene) rule = {{}, {"type", "id", "name", "version"}};
  if (is_root && is_strict_) rule.required.emplace_back("version");
  check_attributes(element, rule);

  Unfinished unfinished = {std::make_shared<Object>(), {}};
  Object& object = *unfinished.object;
  object.family = element.tag == "spectrum" ? "texture" : element.tag;
  object.type = is_scene ? "" : upgraded_type(object.family, element.value("type"), source.version);
  object.id = element.value("id");
  object.place = element.place;
  if (!object.id.empty())
    references_.declare(object.id, unfinished.object, element.place, problems_);
  if (++depth_ > maximum_depth) {
    problems_.add(fmt::format("elements nest more than {} levels deep", maximum_depth),
                  "make the scene flatter", element.place);
    problems_.throw_if_any();
  }
  read_parts(element.node, unfinished, source);
  --depth_;
  upgrade_object(object, element.value("type"), source.version, problems_);
  if (!is_strict_) scale_reflectances(object);
  if (!is_strict_) leave_out_specular(object);
  if (!is_strict_ && source.version < first_with_snake_case) scale_sum_of_reflectances(object);
  if (source.version < first_with_snake_case && object.family == "shape")
    old_shapes_.push_back(unfinished.object);
  if (object.family == "bsdf" && source.version < first_with_snake_case)
    old_bsdfs_.push_back({unfinished.object, element.value("type"), source.version});
  if (lacks_units(object)) daylights_.push_back(&object);
  upgrade_sky(object, source.version);
  upgrade_medium(object, source.version);
  if (loads_materials(object, source.version)) old_obj_shapes_.insert(&object);
  return unfinished.object;
}

void Reader::read_nested_object(const Element& element, Unfinished& parent, Source& source) {
  if (element.tag == "scene") {
    problems_.add("a <scene> in an object", "only the root element is a scene; use <include>",
                  element.place);
    return;
  }
  const std::string name = upgraded_name(element.value("name"), *parent.object, source.version);
  take_name(parent, name, element.place);
  parent.object->children.push_back({name, read_object(element, source)});
}

void Reader::read_reference(const Element& element, Unfinished& parent, Source& source) {
  refuse_children(element, source);
  if (!check_attributes(element, {{"id"}, {"name"}})) return;
  const std::string name = upgraded_name(element.value("name"), *parent.object, source.version);
  take_name(parent, name, element.place);
  references_.refer(parent.object, name, element.value("id"), element.place);
}

void Reader::read_alias(const Element& element, Unfinished&, Source& source) {
  refuse_children(element, source);
  if (!check_attributes(element, {{"id", "as"}, {}})) return;
  references_.declare_alias(element.value("id"), element.value("as"), element.place, problems_);
}

void Reader::read_default(const Element& element, Unfinished&, Source& source) {
  refuse_children(element, source);
  if (!check_attributes(element, {{"name", "value"}, {}})) return;
  const Attribute& name = *element.find("name");
  try {
    definitions_.set_default(name.value, element.value("value"));
  } catch (const BadValue& bad) {
    add(problems_, bad, name.place);
  }
}

}  // namespace kaustik::mitsuba
