#pragma once
#include <vector>

namespace kaustik {

/// How a curve from world to display luminance is made (see HistogramAdjustment).
struct HistogramSettings {
  double display_white = 100;  ///< cd/m²
  double display_black = 1;    ///< cd/m², in (0, display_white)
  int bins = 100;              ///< of the histogram of log luminance
  /// Contrast is limited by what the eye sees (section 4.4) instead of by the scene's (4.3).
  bool human_contrast = false;
  /// No bands: see HistogramAdjustment. False: the paper's algorithm to the letter.
  bool smooth = true;
};

/// From world luminance to display luminance (both cd/m²): histogram adjustment (Ward Larson,
/// Rushmeier and Piatko 1997, section 4). The curve is steep where many parts of the picture are,
/// but its slope stays below a ceiling:
///   dLd/dLw ≤ Ld/Lw                                      (no more contrast than in the scene), or
///   dLd/dLw ≤ visible_difference(Ld) / visible_difference(Lw)        (no more than can be seen).
/// The paper counts samples into bins of log luminance and cuts what stands above the ceiling,
/// again and again until less than 2.5 % of all samples had to be cut; if so little is left, the
/// display is ample and luminance is scaled by a factor that maps the middle of the world's (log)
/// range to that of the display, or with human contrast the threshold there to the threshold.
///
/// Bins without samples get no contrast from that, which shows as bands, and two crowds far apart
/// count as "ample". `smooth` therefore shares samples between neighbouring bins, lets no bin have
/// less than 15 % of its ceiling (more if the crowds cannot fill the display's range; less where
/// that would take over a quarter of it), and solves for the cut histogram exactly instead of to
/// 2.5 %. With human contrast an ample display is used from its black upward as far as the visible
/// differences of the scene reach.
class HistogramAdjustment {
 public:
  /// `luminances` of foveal samples, cd/m²; those not positive and finite are left out, and those
  /// eight decades below the largest count as if they were there.
  HistogramAdjustment(const std::vector<float>& luminances, const HistogramSettings& settings);

  /// Monotonic; in [display black, display white]. What is not positive is black.
  float display_luminance(float world_luminance) const;
  /// World luminance is merely scaled.
  bool is_linear() const { return is_linear_; }
  /// Natural logarithms of the range that the curve was made for, cd/m².
  double log_min() const { return log_min_; }
  double log_max() const { return log_max_; }

 private:
  double bin_width() const { return (log_max_ - log_min_) / settings_.bins; }
  double display_range() const { return log_white_ - log_black_; }
  double log_display(double log_world) const;
  std::vector<double> count(const std::vector<double>& logs) const;
  double visible_slope(double log_world) const;
  std::vector<double> ceilings() const;
  void set_curve(const std::vector<double>& bins, double total);
  bool cut_as_in_the_paper(std::vector<double> bins);
  bool adjust_smoothly(const std::vector<double>& bins);
  void scale_linearly();

  HistogramSettings settings_;
  double log_black_, log_white_;  ///< of the display
  double log_min_ = 0, log_max_ = 0;
  bool is_linear_ = true;
  double log_scale_ = 0;            ///< display over world luminance, if linear
  std::vector<double> cumulative_;  ///< at the borders of the bins, 0 to 1
};

}  // namespace kaustik
