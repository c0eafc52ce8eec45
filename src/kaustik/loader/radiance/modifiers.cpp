#include "kaustik/loader/radiance/modifiers.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/error.h"
#include "kaustik/loader/near_names.h"

namespace kaustik::radiance {
namespace {

bool names_modifiers(const Primitive& primitive) {
  return kind_of(primitive.type) == Kind::mixture || primitive.type == "illum" ||
         primitive.type == "mirror" || primitive.type == "antimatter";
}

/// Whether it matters where it is placed.
bool depends_on_place(const Primitive& primitive) {
  const Kind kind = kind_of(primitive.type);
  if (kind != Kind::material) return true;
  for (const char* type : {"plastic", "metal", "trans", "glass", "light", "mirror", "illum"})
    if (primitive.type == type) return false;
  return true;
}

}  // namespace

ModifierPointer Modifiers::find(const std::string& name, const Place& place) const {
  if (name == "void") return nullptr;
  const auto found = known_.find(name);
  if (found != known_.end()) return found->second;
  const std::string nearest = suggestion_for(name);
  throw Error(ErrorKind::input, fmt::format("no modifier '{}' is defined before", name),
              nearest.empty()
                  ? "define the material above its use, load a file that has all of the scene "
                    "(a .rif names the materials, too), or write 'void' for none"
                  : nearest + " Materials stand above their use",
              place);
}

std::string Modifiers::suggestion_for(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& entry : known_)
    if (names.size() < 10'000 && !stand_ins_.contains(entry.first)) names.push_back(entry.first);
  return did_you_mean(name, names);
}

bool Modifiers::is_unheard_of(const std::string& name) const {
  return name != "void" && !known_.contains(name) && suggestion_for(name).empty();
}

void Modifiers::define_stand_in(const std::shared_ptr<const Primitive>& primitive) {
  stand_ins_.insert(primitive->id);
  define(primitive, {});
}

void Modifiers::define(std::shared_ptr<const Primitive> primitive, const Transform& placed) {
  const Place& place = primitive->place;
  if (primitive->type == "alias") {
    const ModifierPointer target = find(primitive->strings.at(0), place);
    ModifierPointer made = target;
    // With another modifier than what it stands for it is a copy of that.
    const ModifierPointer below =
        primitive->modifier == "inherit" ? nullptr : find(primitive->modifier, place);
    if (primitive->modifier != "inherit" && target && below != target->below) {
      auto copy = std::make_shared<Modifier>(*target);
      copy->below = below;
      copy->depth = std::max(copy->depth, below ? below->depth + 1 : 0);
      if (copy->depth > deepest)
        throw Error(ErrorKind::input, fmt::format("more than {} modifiers hang together", deepest),
                    "shorten the chain", place);
      all_.push_back(copy);
      made = copy;
    }
    known_[primitive->id] = made;
    return;
  }
  auto made = std::make_shared<Modifier>();
  made->placed = placed;
  made->below = find(primitive->modifier, place);
  if (made->below) {
    made->depth = made->below->depth + 1;
    made->mixtures = made->below->mixtures;
  }
  if (names_modifiers(*primitive))
    for (const std::string& name : primitive->strings) {
      const auto found = known_.find(name);
      if (found == known_.end()) continue;
      made->named[name] = found->second;
      if (!found->second) continue;
      made->depth = std::max(made->depth, found->second->depth + 1);
      made->mixtures = std::max(made->mixtures, found->second->mixtures + 1);
    }
  if (made->depth > deepest)
    throw Error(ErrorKind::input, fmt::format("more than {} modifiers hang together", deepest),
                "shorten the chain", place);
  if (made->mixtures > deepest_mixture)
    throw Error(ErrorKind::input, fmt::format("mixtures nest more than {} deep", deepest_mixture),
                "mix fewer modifiers", place);
  ModifierPointer& known = known_[primitive->id];
  if (known && known->primitive == primitive && known->below == made->below &&
      known->named == made->named && (known->placed == placed || !depends_on_place(*primitive)))
    return;
  made->primitive = std::move(primitive);
  all_.push_back(made);
  known = made;
}

Look look_of(const Modifier* modifier) {
  Look look;
  for (; modifier; modifier = modifier->below.get()) switch (kind_of(modifier->type())) {
      case Kind::pattern:
        look.patterns.push_back(modifier);
        break;
      case Kind::texture:
        look.textures.push_back(modifier);
        break;
      case Kind::mixture:
        if (look.material) return look;
        look.mixture = modifier;
        return look;
      case Kind::material:
        if (look.material) return look;
        look.material = modifier;
        break;
      default:
        return look;
    }
  return look;
}

}  // namespace kaustik::radiance
