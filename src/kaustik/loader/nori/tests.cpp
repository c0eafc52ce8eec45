#include "kaustik/loader/nori/tests.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"
#include "kaustik/base/statistics.h"
#include "kaustik/loader/mitsuba_values.h"
#include "kaustik/loader/nori/scenes.h"

namespace kaustik::nori {
namespace {

constexpr size_t most_claims = 10'000;

std::vector<double> numbers_in(Given& given, std::string_view name) {
  std::vector<double> numbers;
  const std::string text = given.text({name}).value_or("");
  try {
    for (const std::string_view part : mitsuba::split_list(text))
      numbers.push_back(mitsuba::parse_float(part));
  } catch (const mitsuba::BadValue& bad) {
    throw Error(ErrorKind::input, bad.what(), bad.remedy, given.place_of({name}));
  }
  return numbers;
}

/// Of a <test> that holds scenes or bsdfs, in the order of the file.
std::vector<const Object*> held_by(const Object& test, const char* family) {
  std::vector<const Object*> objects;
  for (const Child& child : test.children)
    if (child.object->family == family) objects.push_back(child.object.get());
  return objects;
}

/// Nori's one, or an error.
double level_of(Given& given) {
  const double level = given.number({"significancelevel"}).value_or(0.01);
  if (level > 0 && level < 1) return level;
  throw Error(ErrorKind::input, "the significance level is no chance between 0 and 1",
              "0.01 is usual", given.place_of({"significancelevel"}));
}

void check_count(size_t claims, size_t references, const std::string& what, const Object& test) {
  if (claims == references && claims > 0 && claims <= most_claims) return;
  throw Error(ErrorKind::input,
              fmt::format("the test has {} {} and {} references", claims, what, references),
              "give a reference for each", test.place);
}

std::vector<NoriTest> means_of(Given& given, Reading& reading) {
  const Object& test = given.element();
  const std::vector<double> references = numbers_in(given, "references"),
                            angles = numbers_in(given, "angles");
  NoriTest claim;
  claim.samples = given.count({"samplecount"}, 100'000, 2);
  claim.level = sidak_level(level_of(given), int(std::max<size_t>(1, references.size())));
  const auto bsdfs = held_by(test, "bsdf"), scenes = held_by(test, "scene");
  if (!bsdfs.empty() && !scenes.empty())
    throw Error(ErrorKind::input, "the test holds both bsdfs and scenes", "make two tests of it",
                test.place);
  std::vector<NoriTest> claims;
  const auto add = [&](std::string name, Description description) {
    claim.name = std::move(name);
    claim.description = std::move(description);
    claim.expected = references[claims.size()];
    claims.push_back(claim);
  };
  if (bsdfs.empty()) {
    check_count(scenes.size(), references.size(), "scenes", test);
    for (const Object* scene : scenes) {
      ReadScene read = scene_of(*scene, reading);
      claim.obstacle = std::move(read.difference);
      add(label_of(*scene), Description{read.scene});
    }
    return claims;
  }
  check_count(bsdfs.size() * angles.size(), references.size(), "angles", test);
  claim.kind = NoriTest::Kind::reflectance;
  for (const Object* bsdf : bsdfs)
    for (const double angle : angles) {
      claim.angle_degrees = angle;
      add(fmt::format("{} at {:g}°", label_of(*bsdf), angle), Description{ball_of(*bsdf, reading)});
    }
  return claims;
}

std::vector<NoriTest> densities_of(Given& given, Reading& reading) {
  NoriTest claim;
  claim.kind = NoriTest::Kind::density;
  claim.rows = int(given.count({"resolution"}, 10, 1));
  const int64_t directions = given.count({"testcount"}, 5, 1);
  claim.minimum_expected = double(given.count({"minexpfrequency"}, 5, 1));
  const auto bsdfs = held_by(given.element(), "bsdf");
  const int64_t claims_in_all = directions * int64_t(bsdfs.size());
  constexpr int most_rows = 100;
  if (bsdfs.empty() || claims_in_all > int64_t(most_claims) || claim.rows > most_rows)
    throw Error(ErrorKind::input,
                bsdfs.empty() ? "the test holds no bsdf" : "the test asks for too much",
                fmt::format("give bsdfs, up to {} rows and up to {} directions in all", most_rows,
                            most_claims),
                given.element().place);
  // As in Nori: about 5000 for each cell.
  const int64_t usual_samples =
      std::min<int64_t>(int64_t{10'000} * claim.rows * claim.rows, 100'000'000);
  const auto samples = given.number({"samplecount"});
  claim.samples =
      samples && *samples < 0 ? usual_samples : given.count({"samplecount"}, usual_samples, 1);
  claim.level = sidak_level(level_of(given), int(claims_in_all));
  std::vector<NoriTest> claims;
  for (const Object* bsdf : bsdfs) {
    claim.description = Description{ball_of(*bsdf, reading)};
    for (int64_t direction = 0; direction < directions; ++direction) {
      claim.direction = int(direction);
      claim.name = fmt::format("{}, direction {}", label_of(*bsdf), direction + 1);
      claims.push_back(claim);
    }
  }
  return claims;
}

}  // namespace

std::vector<NoriTest> tests_of(const Object& element, Reading& reading) {
  Given given(element, reading.deviations);
  std::set<const Object*> taken;
  for (const Child& child : element.children)
    if (child.object->family == "bsdf" || child.object->family == "scene")
      taken.insert(child.object.get());
  reading.ignore_parts(element, taken);
  if (element.type == "ttest") return means_of(given, reading);
  if (element.type == "chi2test") return densities_of(given, reading);
  throw Error(ErrorKind::input, "there is no such test here",
              "tests are of the types ttest and chi2test", element.place);
}

}  // namespace kaustik::nori
