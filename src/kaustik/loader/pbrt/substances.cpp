// Substances whose scattering was measured.

#include <iterator>
#include <string_view>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/pbrt/media.h"

namespace kaustik::pbrt {
namespace {

/// In small letters; see Jensen et al. 2001 and Narasimhan et al. 2006.
constexpr std::string_view substances[] = {"apple",
                                           "chicken1",
                                           "chicken2",
                                           "cream",
                                           "ketchup",
                                           "marble",
                                           "potato",
                                           "skimmilk",
                                           "skin1",
                                           "skin2",
                                           "spectralon",
                                           "wholemilk",
                                           "lowfat milk",
                                           "reduced milk",
                                           "regular milk",
                                           "espresso",
                                           "mint mocha coffee",
                                           "lowfat soy milk",
                                           "regular soy milk",
                                           "lowfat chocolate milk",
                                           "regular chocolate milk",
                                           "coke",
                                           "pepsi",
                                           "sprite",
                                           "gatorade",
                                           "chardonnay",
                                           "white zinfandel",
                                           "merlot",
                                           "budweiser beer",
                                           "coors light beer",
                                           "clorox",
                                           "apple juice",
                                           "cranberry juice",
                                           "grape juice",
                                           "ruby grapefruit juice",
                                           "white grapefruit juice",
                                           "shampoo",
                                           "strawberry shampoo",
                                           "head & shoulders shampoo",
                                           "lemon tea powder",
                                           "orange juice powder",
                                           "pink lemonade powder",
                                           "cappuccino powder",
                                           "salt powder",
                                           "sugar powder",
                                           "suisse mocha powder",
                                           "pacific ocean surface water"};

}  // namespace

std::string substance_named(const std::string& name) {
  const std::string wanted = is_same_name(name, "orange powder") ? "orange juice powder" : name;
  for (const std::string_view known : substances)
    if (is_same_name(known, wanted)) return std::string(known);
  return {};
}

std::string substance_suggestion(const std::string& name) {
  return did_you_mean(name, {std::begin(substances), std::end(substances)});
}

}  // namespace kaustik::pbrt
