// Files of luminaires: what they say, by closed forms; symmetries; what is odd; damage.

#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/light/photometric_file.h"
#include "tests/light/light_testing.h"
#include "tests/light/photometric_samples.h"
#include "tests/loader/damage.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

double radians(double degrees) { return degrees * double_pi / 180; }
double candela(const Photometry& file, double c, double gamma) {
  const double turn = c / 360 - std::floor(c / 360);
  return file.candelas.value({turn, std::cos(radians(gamma))});
}
/// Different everywhere.
double uneven(double c, double gamma) {
  return 100 + 20 * std::cos(radians(c - 40)) * std::sin(radians(gamma)) + 0.3 * gamma;
}
bool remarks(const Photometry& file, const std::string& text) {
  for (const std::string& remark : file.remarks)
    if (remark.find(text) != std::string::npos) return true;
  return false;
}

TEST(PhotometricFile, FluxIsTheIntegral) {
  const auto flat = [](double, double) { return 100; };
  EXPECT_NEAR(read_ies(ies_text({0, 90, 180}, {0}, flat), "a").candelas.integral(), 400 * double_pi,
              1e-9);
  // No light beyond the last angle.
  EXPECT_NEAR(read_ies(ies_text({0, 45, 90}, {0}, flat), "a").candelas.integral(), 200 * double_pi,
              1e-9);
  EXPECT_NEAR(read_ies(ies_text({90, 180}, {0}, flat), "a").candelas.integral(), 200 * double_pi,
              1e-9);
  // cos γ: π I₀, but for the lines between its nodes.
  const auto matt = [](double, double v) { return 50 * std::cos(radians(v)); };
  EXPECT_NEAR(read_ies(ies_text(even_angles(0, 90, 90), {0}, matt), "a").candelas.integral(),
              50 * double_pi, 0.01);
  // ∫ (1 + cos C) dC = 2π, whatever the steps.
  const auto lobe = [](double c, double) { return 10 * (1 + std::cos(radians(c))); };
  EXPECT_NEAR(read_ies(ies_text({0, 180}, even_angles(0, 360, 24), lobe), "a").candelas.integral(),
              40 * double_pi, 1e-5);
}

TEST(PhotometricFile, SymmetriesOfTypeC) {
  const auto vertical = even_angles(0, 180, 36);
  const auto check = [&](double from, double to, const auto& stands_for) {
    SCOPED_TRACE(fmt::format("{} to {}", from, to));
    const Photometry file = read_ies(ies_text(vertical, even_angles(from, to, 18), uneven), "a");
    EXPECT_TRUE(file.remarks.empty()) << file.remarks.front();
    for (const double c : {0., 30., 80., 120., 170., 200., 260., 290., 340.})
      EXPECT_NEAR(candela(file, c, 60), uneven(stands_for(c), 60), 0.4) << c;
  };
  check(0, 360, [](double c) { return c; });
  check(0, 180, [](double c) { return c <= 180 ? c : 360 - c; });
  check(90, 270, [](double c) { return c >= 90 && c <= 270 ? c : 180 - c; });
  check(0, 90,
        [](double c) { return std::acos(std::fabs(std::cos(radians(c)))) * 180 / double_pi; });
  const Photometry one = read_ies(ies_text(vertical, {45}, uneven), "a");
  for (const double c : {0., 100., 300.}) EXPECT_NEAR(candela(one, c, 60), uneven(45, 60), 1e-4);
  EXPECT_TRUE(remarks(one, "its only plane is at 45°"));
  // Without 360, where the step fits, and with a gap.
  EXPECT_TRUE(read_ies(ies_text(vertical, even_angles(0, 345, 23), uneven), "a").remarks.empty());
  EXPECT_TRUE(remarks(read_ies(ies_text(vertical, {0, 30, 60, 100}, uneven), "a"), "in the gap"));
}

TEST(PhotometricFile, TypesBAndA) {
  // A narrow beam toward H 30, V 50 of type B, and of type A.
  const auto beam = [](double h, double v) {
    return 1000 * std::exp(-(std::pow(h - 30, 2) + std::pow(v - 50, 2)) / 200);
  };
  const auto angles = even_angles(-90, 90, 36);
  const auto brightest = [&](int type) {
    const Photometry file = read_ies(ies_text(angles, angles, beam, "IESNA:LM-63-1995", type), "a");
    const LatLong at = file.candelas.brightest();
    const double sine = std::sqrt(1 - at.height * at.height);
    return Vec3d(sine * std::cos(2 * double_pi * at.turn), sine * std::sin(2 * double_pi * at.turn),
                 at.height);
  };
  const double h = radians(30), v = radians(50);
  const Vec3d of_b(std::cos(h) * std::sin(v), std::sin(h), std::cos(h) * std::cos(v));
  const Vec3d of_a(std::cos(v) * std::sin(h), std::sin(v), std::cos(v) * std::cos(h));
  EXPECT_GT(brightest(2).dot(of_b), std::cos(radians(1)));
  EXPECT_GT(brightest(3).dot(of_a), std::cos(radians(1)));
  // Over half of the sphere; dω = cos H dH dV.
  const auto flat = [](double, double) { return 100; };
  const Photometry half = read_ies(ies_text({0, 90}, {0, 90}, flat, "IESNA91", 2), "a");
  EXPECT_NEAR(half.candelas.integral(), 200 * double_pi, 3);
  EXPECT_NEAR(candela(half, 200, 89), 100, 1e-3);
  EXPECT_EQ(candela(half, 200, 92), 0);
}

TEST(PhotometricFile, FactorsByVersion) {
  const auto flat = [](double, double) { return 100; };
  const auto first = [&](const std::string& version, const std::string& factors) {
    return candela(read_ies(ies_text({0, 180}, {0}, flat, version, 1, factors), "a"), 0, 50);
  };
  EXPECT_FLOAT_EQ(float(first("IESNA91", "0.9 0.8 20")), 72);
  EXPECT_FLOAT_EQ(float(first("a luminaire of 1986", "0.9 0.8 20")), 72);
  EXPECT_FLOAT_EQ(float(first("IESNA:LM-63-1995", "0.9 1 20")), 90);
  // A code, no factor.
  EXPECT_FLOAT_EQ(float(first("IES:LM-63-2019", "0.9 1.10000 20")), 90);
  std::string tilted = ies_text({0, 180}, {0}, flat);
  const std::string none = "TILT=NONE\n";
  tilted.replace(tilted.find(none), none.size(), "TILT = include\n1\n3\n0 45 90\n.7 .6 .5\n");
  EXPECT_FLOAT_EQ(float(candela(read_ies(tilted, "a"), 0, 50)), 70);
}

TEST(PhotometricFile, EulumdatKeepsItsSymmetries) {
  const auto all = even_angles(0, 345, 23), angles = even_angles(0, 180, 36);
  const auto check = [&](int symmetry, const std::vector<double>& stored, const auto& stands_for) {
    SCOPED_TRACE(symmetry);
    const Photometry file =
        read_photometry(eulumdat_text(symmetry, all, stored, angles, uneven), "a.ldt");
    EXPECT_TRUE(file.remarks.empty()) << file.remarks.front();
    // cd per 1000 lm, of 2000 lm.
    for (const double c : {0., 30., 75., 120., 165., 210., 255., 285., 345.})
      EXPECT_NEAR(candela(file, c, 60), 2 * uneven(stands_for(c), 60), 1e-3) << c;
  };
  check(0, all, [](double c) { return c; });
  check(1, {0}, [](double) { return 0.; });
  check(2, even_angles(0, 180, 12), [](double c) { return c <= 180 ? c : 360 - c; });
  check(3, even_angles(270, 450, 12), [](double c) { return c <= 90 || c >= 270 ? c : 180 - c; });
  check(4, even_angles(0, 90, 6),
        [](double c) { return std::acos(std::fabs(std::cos(radians(c)))) * 180 / double_pi; });
}

TEST(PhotometricFile, TellsWhatIsOdd) {
  const auto flat = [](double, double) { return 100; };
  const std::string sound = ies_text({0, 45, 90}, {0}, flat);
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = sound;
    changed.replace(changed.find(old), old.size(), text);
    return read_ies(changed, "a");
  };
  EXPECT_TRUE(read_ies(sound, "a").remarks.empty());
  EXPECT_TRUE(remarks(with("1 1000 1 3", "1 1000 0 3"), "its multiplier is 0: it is taken as 1"));
  EXPECT_TRUE(remarks(with("0 45 90 \n", "90 45 0\n"), "its angles do not ascend"));
  EXPECT_TRUE(remarks(with("100 100 100", "100 -3 100"), "1 of its intensities is below 0"));
  EXPECT_TRUE(remarks(with("0 45 90 \n", "30 60 90\n"), "the first angle is 30°"));
  EXPECT_TRUE(remarks(with("100 100 100", "100 100 100 7"), "is left out"));
  EXPECT_NE(with("1 1000", "1 -1").facts.find("absolute"), std::string::npos);
  EXPECT_FLOAT_EQ(float(candela(with("100 100 100", "100,5 100,5 100,5"), 0, 20)), 100.5f);
  // Any system's lines, commas between, a mark of UTF-8.
  std::string foreign = "\xef\xbb\xbf" + sound + "\x1a";
  for (char& c : foreign) c = c == '\n' ? '\r' : c;
  EXPECT_FLOAT_EQ(float(candela(read_photometry(foreign, "a.ies"), 0, 20)), 100);
  const auto matt = [](double, double g) { return 318.31 * std::cos(radians(g)); };
  EXPECT_TRUE(
      remarks(read_eulumdat(eulumdat_text(1, {0}, {0}, even_angles(0, 90, 18), matt, 70), "a"),
              "it says 70 %"));
}

std::string refusal(const std::string& text, const std::string& name = "lamp.ies") {
  try {
    read_photometry(text, name);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(PhotometricFile, MessagesHaveTheLine) {
  const auto flat = [](double, double) { return 100; };
  const std::string sound = ies_text({0, 45, 90}, {0}, flat);
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = sound;
    changed.replace(changed.find(old), old.size(), text);
    return refusal(changed);
  };
  EXPECT_EQ(with("TILT=NONE", "TILD=NONE").substr(0, 59),
            "lamp.ies:8: there is no line TILT=: this is no IES file, or");
  EXPECT_NE(with("100 100 100", "100 oops 100").find("lamp.ies:8: 'oops' is not a number"),
            std::string::npos);
  EXPECT_NE(
      with("100 100 100", "100 100").find("there are 2 intensities, and the angles ask for 3"),
      std::string::npos);
  EXPECT_NE(with(" 3 1 1 2 0", " 3 1 4 2 0").find("the type of photometry is 4"),
            std::string::npos);
  EXPECT_NE(with(" 3 1 1 2 0", " 1e9 1 1 2 0").find("the number of vertical angles is 1e+09"),
            std::string::npos);
  EXPECT_NE(with("0 45 90 \n", "0 45 190\n").find("lie between 0° and 180°"), std::string::npos);
  EXPECT_NE(with("100 100 100", "100 1e200 1e300").find("too large"), std::string::npos);
  EXPECT_NE(refusal("Maker\n1\n7\n24\n", "lamp.ldt").find("the symmetry is 7, not 0 to 4"),
            std::string::npos);
  EXPECT_NE(refusal("Maker\n1\n1\n24\n", "lamp.ldt").find("the file ends"), std::string::npos);
  for (const std::string text :
       {"", "TILT=NONE", "TILT=INCLUDE 1 2", "\n\n", "IESNA91\nTILT=NONE\n1"})
    EXPECT_NE(refusal(text), "none");
}

/// False if it was refused as it should be; what is read must be a distribution.
bool survives_photometry(const std::string& text, const std::string& name) {
  try {
    const Photometry file = read_photometry(text, name);
    const IntensitySampler sampler(file.candelas);
    EXPECT_TRUE(std::isfinite(file.candelas.integral()));
    EXPECT_GE(file.candelas.value({0.3, 0.2}), 0);
    if (file.candelas.integral() > 0) {
      const LatLong at = sampler.sample({0.4f, 0.7f});
      EXPECT_TRUE(std::isfinite(sampler.pdf(at)));
    }
  } catch (const Error& error) {
    for (const Problem& problem : error.problems()) {
      EXPECT_FALSE(problem.message.empty());
      EXPECT_FALSE(problem.remedy.empty());
      EXPECT_TRUE(problem.place.file) << problem.message;
    }
    return false;
  }
  return true;
}

TEST(PhotometricFileFuzz, DamagedFiles) {
  const std::string ies = ies_text({0, 10, 25, 90}, {0, 30, 90}, uneven);
  const std::string ldt = eulumdat_text(4, {0, 90, 180, 270}, {0, 90}, {0, 30, 60, 90}, uneven, 50);
  for (const std::string name : {"a.ies", "a.ldt"}) {
    const std::string& whole = name == "a.ies" ? ies : ldt;
    const auto survives = [&](const std::string& text) { return survives_photometry(text, name); };
    ASSERT_TRUE(survives(whole));
    for (size_t size = 0; size < whole.size() - 20; ++size)
      EXPECT_FALSE(survives(whole.substr(0, size))) << name << size;
    const int rounds = damage_rounds(300, 100);
    EXPECT_GT(count_refused(whole, 1, rounds, 4, flip_byte, survives), rounds / 20);
    const Change words = exchanged_word({"0", "-1", "1e30", "nan", "99999999999", "1e-30", ",", "2",
                                         "3", "TILT=INCLUDE", "180.5", "0.01", "719"});
    count_refused(whole, 2, rounds, 3, either(exchanged_piece(whole, 7), words), survives);
  }
}

}  // namespace
}  // namespace kaustik
