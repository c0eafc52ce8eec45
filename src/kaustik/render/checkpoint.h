#pragma once
// Renders that can be gone on with: what a film holds, and all that its passes are a function of.

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/base/binary_file.h"
#include "kaustik/render/film.h"
#include "kaustik/render/pass_division.h"
#include "kaustik/scene/description_digest.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// What the passes are a function of: the scene's file, and what is changed of it.
struct RenderRecipe {
  std::string scene;   ///< file, relative to `folder` or absolute; "": it never was in one
  std::string folder;  ///< that relative names were meant in, for people
  /// Names and values of the file's variables.
  std::vector<std::pair<std::string, std::string>> definitions;
  bool is_strict = false;  ///< LoadOptions; not kept: what was accepted once is so again
  std::string camera;      ///< by its id; "": the first
  /// A file of points to measure at instead, relative to `folder` or absolute; "": none.
  std::string points;
  std::string integrator;         ///< instead of the file's; "": that
  std::vector<Setting> settings;  ///< made after that; later ones win
  uint64_t seed = 0;
  uint32_t samples_per_pass = 1;
  /// digest_of() the lessons that hold for all passes; 0: passes learn for themselves.
  uint64_t lessons = 0;
  DescriptionDigest digest;  ///< of the description after all of these
};

/// How far the render was to go.
struct StopPlan {
  uint32_t first_pass = 0;
  uint32_t passes = 0;            ///< from the first on; 0: limited by time or error
  std::optional<double> seconds;  ///< of all sessions together
  std::optional<double> error;    ///< of the picture, Film::picture_error()
  PassDivision division = {};     ///< of which these passes are one part or several
};

/// The image files that were asked for.
struct OutputPlan {
  std::vector<std::string> files;
  std::string tone = "histogram";
  std::vector<std::string> tone_settings;  ///< "parameter=value"
  bool denoise = false, full_float = false, reproducible = false;
};

/// What image files tell of the scene beside its light.
struct ViewFacts {
  std::string integrator;                       ///< that was used
  double horizontal_fov = 0, vertical_fov = 0;  ///< degrees
  Quantity quantity = Quantity::radiance;
  double exposure = 0;  ///< of the film, stops
  PictureFrame frame;   ///< of a crop window; no size: the image is all of the picture
};

/// All that is known of a render beside its sums.
struct RenderRecord {
  std::string program;  ///< version
  /// Of the machines that have rendered passes. Of several, passes may differ in their last bits.
  std::set<std::string> instruction_sets = {};
  RenderRecipe recipe;
  StopPlan plan;
  OutputPlan outputs;
  ViewFacts view;
  double seconds = 0;  ///< that it took so far
};

struct Checkpoint {
  RenderRecord record;
  Film film;
  Lessons lessons;  ///< that its passes have taught, or that hold for all of them
};

/// Writes a .kpt file atomically; throws as write_file_atomically() does, and Error(system) if
/// there is too little memory to collect it.
void write_checkpoint(const std::string& path, const RenderRecord& record, const Film& film,
                      const Lessons& lessons = {});
/// The same, as write_file_atomically_if() does.
bool write_checkpoint_if(const std::string& path, const RenderRecord& record, const Film& film,
                         const Lessons& lessons, const std::function<bool()>& is_wanted);

/// The bytes of that file, for memory or a connection.
std::vector<uint8_t> checkpoint_bytes(const RenderRecord& record, const Film& film,
                                      const Lessons& lessons = {});

/// Throws Error(input) if the file is missing, no checkpoint, of another version or byte order,
/// truncated or damaged (a checksum covers every byte). Allocates in proportion to the file's size.
Checkpoint read_checkpoint(const std::string& path);
/// The same of its bytes, which messages call by `name`.
Checkpoint parse_checkpoint(std::vector<uint8_t> bytes, const std::string& name);

/// Whether the file starts as checkpoints do. Throws Error(input) if it cannot be read.
bool is_checkpoint(const std::string& path);

/// A checkpoint's file, of which all but the film's sums is read at once. Throws as
/// read_checkpoint() does, but if only its frame is checked nobody knows whether what it says is
/// what was written.
class CheckpointReader {
 public:
  explicit CheckpointReader(const std::string& path, FileCheck check = FileCheck::whole);
  CheckpointReader(std::vector<uint8_t> bytes, const std::string& name);

  const RenderRecord& record() const { return record_; }
  const Lessons& lessons() const { return lessons_; }
  const FilmHead& film_head() const { return film_head_; }

  // The sums, once.
  Film film();
  /// Film::add().
  PassSet add_film_to(Film& whole);

 private:
  void read_head();
  void check_regions(const Film& film) const;

  BinaryReader reader_;
  RenderRecord record_;
  Lessons lessons_;
  FilmHead film_head_;
};

}  // namespace kaustik
