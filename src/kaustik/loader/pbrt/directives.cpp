#include "kaustik/loader/pbrt/directives.h"

#include <fmt/format.h>

#include <stdexcept>

#include "kaustik/loader/near_names.h"

namespace kaustik::pbrt {
namespace {

constexpr size_t most_saved_states = 10'000;
/// Of names, which are kept for each shape.
constexpr size_t most_name_bytes = 500;

constexpr std::string_view attribute_names[attribute_kinds] = {"shape", "light", "material",
                                                               "medium", "texture"};

}  // namespace

Directives::Directives(SceneFiles& files, Deviations& deviations)
    : files_(files), deviations_(deviations), world_(files, deviations) {}

const std::map<std::string_view, Directives::Handler>& Directives::handlers() {
  using D = Directives;
  static const std::map<std::string_view, Handler> rows = {
      {"Accelerator", &D::accelerator},
      {"ActiveTransform", &D::active_transform},
      {"AreaLightSource", &D::area_light_source},
      {"Attribute", &D::attribute},
      {"AttributeBegin", &D::attribute_begin},
      {"AttributeEnd", &D::attribute_end},
      {"Camera", &D::camera},
      {"ColorSpace", &D::colour_space},
      {"ConcatTransform", &D::concat_transform},
      {"CoordSysTransform", &D::coord_sys_transform},
      {"CoordinateSystem", &D::coordinate_system},
      {"Film", &D::film},
      {"Identity", &D::identity},
      {"Import", &D::import},
      {"Include", &D::include},
      {"Integrator", &D::integrator},
      {"LightSource", &D::light_source},
      {"LookAt", &D::look_at},
      {"MakeNamedMaterial", &D::make_named_material},
      {"MakeNamedMedium", &D::make_named_medium},
      {"Material", &D::material},
      {"MediumInterface", &D::medium_interface},
      {"NamedMaterial", &D::named_material},
      {"ObjectBegin", &D::object_begin},
      {"ObjectEnd", &D::object_end},
      {"ObjectInstance", &D::object_instance},
      {"Option", &D::option},
      {"PixelFilter", &D::pixel_filter},
      {"Renderer", &D::accelerator},
      {"ReverseOrientation", &D::reverse_orientation},
      {"Rotate", &D::rotate},
      {"Sampler", &D::sampler},
      {"Scale", &D::scale},
      {"Shape", &D::shape},
      {"SurfaceIntegrator", &D::integrator},
      {"Texture", &D::texture},
      {"Transform", &D::transform},
      {"TransformBegin", &D::transform_begin},
      {"TransformEnd", &D::transform_end},
      {"TransformTimes", &D::transform_times},
      {"Translate", &D::translate},
      {"VolumeIntegrator", &D::accelerator},
      {"WorldBegin", &D::world_begin},
      {"WorldEnd", &D::world_end},
  };
  return rows;
}

bool is_directive(std::string_view word) { return Directives::knows(word); }

bool Directives::knows(std::string_view word) { return handlers().contains(word); }

void Directives::run(const SourceText& text) {
  Tokenizer tokens(text);
  for (Token word = tokens.next(); word.kind != TokenKind::end; word = tokens.next())
    run_one({tokens, word});
}

void Directives::run_one(const Call& call) {
  const auto refuse = [&](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy, call.place());
  };
  if (call.word.kind != TokenKind::word)
    refuse(fmt::format("{} stands where a directive is expected", shown(call.word.text)),
           "begin with a word such as Shape or Material");
  const auto handler = handlers().find(call.word.text);
  if (handler == handlers().end())
    refuse(fmt::format("there is no directive {}", shown(call.word.text)),
           suggest(std::string(call.word.text.substr(0, 40)), names_in(handlers())));
  try {
    (this->*handler->second)(call);
  } catch (const std::invalid_argument&) {
    refuse("a transform is singular, or beyond all numbers", "use less extreme factors");
  }
}

std::string Directives::quoted(const Call& call, const char* what) {
  const Token token = call.tokens.next();
  if (token.kind != TokenKind::quoted)
    throw Error(ErrorKind::input, fmt::format("{} lacks {}", call.word.text, what),
                "write it in quotes", call.tokens.place_of(token));
  if (token.text.size() > most_name_bytes)
    throw Error(
        ErrorKind::input,
        fmt::format("{} of {} has more than {} bytes", what, call.word.text, most_name_bytes),
        "give it a shorter one", call.tokens.place_of(token));
  return unescaped(token.text);
}

ParameterList Directives::parameters(const Call& call) {
  return ParameterList::read(call.tokens, call.place());
}

Setting Directives::setting(const Call& call) {
  std::string type = quoted(call, "a type");
  return {std::move(type), parameters(call)};
}

void Directives::push(const Call& call, bool is_transform_only) {
  if (saved_.size() >= most_saved_states)
    throw Error(ErrorKind::input,
                fmt::format("attributes nest more than {} deep", most_saved_states),
                "end them by AttributeEnd", call.place());
  saved_.push_back({state_, is_transform_only, call.place()});
}

void Directives::pop(const Call& call, bool is_transform_only) {
  if (saved_.empty() || saved_.back().is_transform_only != is_transform_only)
    throw Error(ErrorKind::input, fmt::format("{} ends nothing that began", call.word.text),
                saved_.empty() ? "take it out"
                               : "end first what began last, " + text_of(saved_.back().place),
                call.place());
  if (is_transform_only) {
    const GraphicsState& before = saved_.back().state;
    state_.transform = before.transform;
    state_.changes_start = before.changes_start;
    state_.changes_end = before.changes_end;
  } else {
    state_ = std::move(saved_.back().state);
  }
  saved_.pop_back();
}

void Directives::attribute_begin(const Call& call) { push(call, false); }
void Directives::attribute_end(const Call& call) { pop(call, false); }
void Directives::transform_begin(const Call& call) { push(call, true); }
void Directives::transform_end(const Call& call) { pop(call, true); }

void Directives::attribute(const Call& call) {
  const std::string name = quoted(call, "what it is for");
  const ParameterList list = parameters(call);
  for (size_t kind = 0; kind < attribute_kinds; ++kind) {
    if (attribute_names[kind] != name) continue;
    auto& known = state_.attributes[kind];
    auto all = std::make_shared<ParameterList>(list);
    if (known) all->add_defaults(*known);
    known = std::move(all);
    return;
  }
  throw Error(ErrorKind::input, fmt::format("there are no attributes of {}", shown(name)),
              suggest(name.substr(0, 40), {attribute_names, attribute_names + attribute_kinds}),
              call.place());
}

void Directives::colour_space(const Call& call) {
  const std::string name = quoted(call, "a name");
  const auto space = colour_space_named(name);
  if (!space)
    throw Error(ErrorKind::input, fmt::format("there is no colour space {}", shown(name)),
                suggest(name.substr(0, 40), {"srgb", "rec2020", "aces2065-1", "dci-p3"}),
                call.place());
  state_.colour_space = *space;
}

void Directives::reverse_orientation(const Call&) {
  state_.reverses_orientation = !state_.reverses_orientation;
}

void Directives::world_begin(const Call&) {
  state_.transform = {};
  state_.changes_start = state_.changes_end = true;
  coordinate_systems_["world"] = {};
}

// pbrt-v3, which alone has WorldEnd, makes its camera here.
void Directives::world_end(const Call&) { camera_medium_ = state_.media.outside; }

void Directives::finish(const Place& place, Description& description) {
  if (!saved_.empty())
    throw Error(ErrorKind::input, "the file ends within attributes that begin here",
                "end them by AttributeEnd", saved_.back().place);
  view_.place = place;
  try {
    world_.finish(view_, camera_medium_, description);
  } catch (const std::invalid_argument&) {
    throw Error(ErrorKind::input, "a transform of the scene is singular, or beyond all numbers",
                "use less extreme sizes", place);
  }
}

}  // namespace kaustik::pbrt
