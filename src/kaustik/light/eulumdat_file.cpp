// EULUMDAT (.ldt): one value on each line, in a fixed order.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/light/photometric_file.h"
#include "kaustik/light/photometric_number.h"

namespace kaustik {
namespace {

constexpr const char* eulumdat_remedy = "get the file again from the maker of the luminaire";
/// Of C planes and of angles; files have up to 721.
constexpr double most_angles = 1e5;

class EulumdatReader {
 public:
  EulumdatReader(std::string_view text, const std::string& name) : name_(name) {
    for (size_t at = 0; at < text.size();) {
      const size_t end = std::min(text.find_first_of("\r\n", at), text.size());
      lines_.push_back(text.substr(at, end - at));
      at = end < text.size() && text.substr(end, 2) == "\r\n" ? end + 2 : end + 1;
    }
  }

  Photometry read() {
    skip(2);  // the company, and what kind of luminaire it is
    const double symmetry = next("the symmetry");
    if (!(symmetry >= 0 && symmetry <= 4 && symmetry == std::floor(symmetry)))
      fail(fmt::format("the symmetry is {:.6g}, not 0 to 4", symmetry));
    const size_t plane_count = next_count("the number of C planes");
    skip(1);  // how far they are apart
    const size_t angle_count = next_count("the number of angles in a plane");
    skip(15);  // their distance, names, sizes
    skip(1);   // the downward part
    const double efficiency = next("the light output ratio");
    double factor = next("the conversion factor");
    if (!(factor > 0)) {
      remark(fmt::format("its conversion factor is {:.4g}: it is taken as 1", factor));
      factor = 1;
    }
    skip(1);  // the tilt when it was measured
    const double lumens = read_lamps();
    skip(10);  // the direct ratios
    const std::vector<double> all_planes = read_angles(plane_count, "the angle of a C plane");
    PhotometricPlanes planes;
    planes.angles = read_angles(angle_count, "an angle in a plane");
    choose_planes(int(symmetry), all_planes, planes);
    read_intensities(planes, lumens / 1000 * factor);
    tidy(planes, remarks_);
    check_angles(planes);
    IntensityTable table = table_of_planes(planes, remarks_);
    check_efficiency(table, lumens * factor, efficiency);
    return {std::move(table), fmt::format("{:.6g} lm of lamps, factor {:.4g}", lumens, factor),
            std::move(remarks_)};
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::input, message, eulumdat_remedy, place_in(name_, int(next_)));
  }
  void remark(std::string text) { remarks_.push_back(std::move(text)); }

  std::string_view line(const char* what) {
    if (next_ >= lines_.size()) fail(fmt::format("the file ends before {}", what));
    return lines_[next_++];
  }
  void skip(size_t count) {
    if (next_ + count > lines_.size()) fail("the file ends within its first lines");
    next_ += count;
  }
  double next(const char* what) {
    const std::string_view word = trimmed(line(what));
    const auto number = photometric_number(word);
    if (!number) fail(fmt::format("{} is '{}', which is not a number", what, word.substr(0, 40)));
    return *number;
  }
  size_t next_count(const char* what) {
    const double number = next(what);
    if (!(number >= 1 && number <= most_angles && number == std::floor(number)))
      fail(fmt::format("{} is {:.6g}", what, number));
    return size_t(number);
  }

  /// The lumens of the first set of lamps; others are alternatives.
  double read_lamps() {
    const size_t sets = next_count("the number of sets of lamps");
    if (sets > lines_.size()) fail(fmt::format("there are {} sets of lamps", sets));
    double lumens = 0;
    for (size_t set = 0; set < sets; ++set) {
      skip(2);  // how many lamps of which type
      if (set == 0) {
        lumens = next("the lumens of the lamps");
        if (!(lumens > 0)) fail(fmt::format("the lumens of the lamps are {:.6g}", lumens));
      } else {
        skip(1);
      }
      skip(3);  // colour, rendering, watts
    }
    if (sets > 1) remark(fmt::format("it has {} sets of lamps: the first one shines", sets));
    return lumens;
  }

  std::vector<double> read_angles(size_t count, const char* what) {
    if (count > lines_.size() - next_)
      fail(fmt::format("the file announces {} angles, and has no such many lines", count));
    std::vector<double> angles(count);
    for (double& angle : angles) angle = next(what);
    return angles;
  }

  /// Which planes are stored, and what they stand for.
  void choose_planes(int symmetry, const std::vector<double>& all, PhotometricPlanes& planes) {
    const size_t count = all.size();
    size_t first = 0, stored = count;
    if (symmetry == 1) stored = 1;
    if (symmetry == 2 || symmetry == 3) stored = count / 2 + 1;
    if (symmetry == 4) stored = count / 4 + 1;
    if (symmetry == 3) first = 3 * count / 4;
    if (stored > count && count > 1) stored = count;
    planes.mirror_at_0 = symmetry == 2 || symmetry == 4;
    planes.mirror_at_90 = symmetry == 3 || symmetry == 4;
    for (size_t i = 0; i < stored; ++i) {
      const size_t at = first + i;
      // They go on beyond C 360, which is C 0.
      planes.planes.push_back(symmetry == 1 ? 0 : all[at % count] + (at >= count ? 360 : 0));
    }
    for (const double plane : planes.planes)
      if (!(plane >= -360 && plane <= 720)) fail(fmt::format("a C plane is at {:.6g}°", plane));
  }

  void read_intensities(PhotometricPlanes& planes, double factor) {
    const size_t count = planes.planes.size() * planes.angles.size();
    if (count > lines_.size() - next_)
      fail(fmt::format("there are {} intensities, and the angles ask for {}", lines_.size() - next_,
                       count));
    planes.candelas.reserve(count);
    for (size_t i = 0; i < count; ++i) {
      planes.candelas.push_back(next("an intensity") * factor);
      if (!(std::fabs(planes.candelas.back()) < 1e30))
        fail("an intensity is too large for a number");
    }
  }

  void check_angles(const PhotometricPlanes& planes) const {
    if (planes.angles.size() < 2) fail("at least two angles make a distribution");
    if (planes.angles.front() < 0 || planes.angles.back() > 180.001)
      fail(fmt::format("the angles in a plane are {:.4g}° to {:.4g}°, not between 0° and 180°",
                       planes.angles.front(), planes.angles.back()));
  }

  /// The ratio follows from the intensities, and is never a factor.
  void check_efficiency(const IntensityTable& table, double lamps, double percent) {
    const double found = 100 * table.integral() / lamps;
    if (percent > 0 && std::fabs(found - percent) > 5)
      remark(
          fmt::format("its intensities come to {:.3g} % of its lamps' lumens, and it says "
                      "{:.3g} %: the intensities count",
                      found, percent));
  }

  const std::string& name_;
  std::vector<std::string_view> lines_;
  size_t next_ = 0;
  std::vector<std::string> remarks_;
};

}  // namespace

Photometry read_eulumdat(std::string_view text, const std::string& name) {
  return EulumdatReader(text, name).read();
}

}  // namespace kaustik
