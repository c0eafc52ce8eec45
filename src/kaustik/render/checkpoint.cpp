// docs/reference/checkpoint_file.md describes the file; what is put and got here is that, in its
// order.
#include "kaustik/render/checkpoint.h"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <tuple>
#include <utility>

#include "kaustik/base/binary_file.h"
#include "kaustik/render/lessons_file.h"

namespace kaustik {
namespace {

constexpr BinaryFileKind checkpoint_kind = {{0x89, 'K', 'P', 'T', '\r', '\n', 0x1a, '\n'},
                                            16,
                                            "checkpoint",
                                            "give a checkpoint (.kpt) that a render has written",
                                            "render again with this program"};

void put_texts(BinaryWriter& writer, const std::vector<std::string>& texts) {
  writer.put(uint64_t(texts.size()));
  for (const std::string& text : texts) writer.put_text(text);
}

std::vector<std::string> get_texts(BinaryReader& reader) {
  std::vector<std::string> texts(reader.get_count(sizeof(uint64_t)));
  for (std::string& text : texts) text = reader.get_text();
  return texts;
}

double get_finite(BinaryReader& reader) {
  const auto value = reader.get<double>();
  if (!std::isfinite(value)) reader.damaged("a number in it is not finite");
  return value;
}

void put_recipe(BinaryWriter& writer, const RenderRecipe& recipe) {
  writer.put_text(recipe.scene);
  writer.put_text(recipe.folder);
  writer.put(uint64_t(recipe.definitions.size()));
  for (const auto& [name, value] : recipe.definitions) {
    writer.put_text(name);
    writer.put_text(value);
  }
  writer.put_text(recipe.camera);
  writer.put_text(recipe.integrator);
  writer.put(uint64_t(recipe.settings.size()));
  for (const Setting& setting : recipe.settings) {
    writer.put_text(assignment_of(setting));
    writer.put_text(setting.origin);
  }
  writer.put(recipe.seed);
  writer.put(recipe.samples_per_pass);
  writer.put(recipe.lessons);
  writer.put(recipe.digest.scene);
  writer.put(recipe.digest.integrator);
}

RenderRecipe get_recipe(BinaryReader& reader) {
  RenderRecipe recipe;
  recipe.scene = reader.get_text();
  recipe.folder = reader.get_text();
  recipe.definitions.resize(reader.get_count(2 * sizeof(uint64_t)));
  for (auto& [name, value] : recipe.definitions) {
    name = reader.get_text();
    value = reader.get_text();
  }
  recipe.camera = reader.get_text();
  recipe.integrator = reader.get_text();
  recipe.settings.resize(reader.get_count(2 * sizeof(uint64_t)));
  for (Setting& setting : recipe.settings) {
    const std::string assignment = reader.get_text();
    setting = setting_from(assignment, reader.get_text());
  }
  recipe.seed = reader.get<uint64_t>();
  recipe.samples_per_pass = reader.get<uint32_t>();
  if (recipe.samples_per_pass == 0 || recipe.samples_per_pass > most_samples_per_pass)
    reader.damaged("the samples of its passes are not valid");
  recipe.lessons = reader.get<uint64_t>();
  recipe.digest.scene = reader.get<uint64_t>();
  recipe.digest.integrator = reader.get<uint64_t>();
  return recipe;
}

void put_optional(BinaryWriter& writer, std::optional<double> value) {
  writer.put(uint8_t(value.has_value()));
  writer.put(value.value_or(0));
}

std::optional<double> get_optional(BinaryReader& reader) {
  const bool given = reader.get_flag();
  const double value = get_finite(reader);
  return given ? std::optional(value) : std::nullopt;
}

void put_plan(BinaryWriter& writer, const StopPlan& plan) {
  writer.put(plan.first_pass);
  writer.put(plan.passes);
  put_optional(writer, plan.seconds);
  put_optional(writer, plan.error);
}

StopPlan get_plan(BinaryReader& reader) {
  StopPlan plan;
  plan.first_pass = reader.get<uint32_t>();
  plan.passes = reader.get<uint32_t>();
  if (plan.first_pass >= pass_limit || plan.passes > pass_limit - plan.first_pass)
    reader.damaged("the passes that it was to have are not valid");
  plan.seconds = get_optional(reader);
  plan.error = get_optional(reader);
  return plan;
}

void put_outputs(BinaryWriter& writer, const OutputPlan& outputs) {
  put_texts(writer, outputs.files);
  writer.put_text(outputs.tone);
  put_texts(writer, outputs.tone_settings);
  for (const bool flag : {outputs.denoise, outputs.full_float, outputs.reproducible})
    writer.put(uint8_t(flag));
}

OutputPlan get_outputs(BinaryReader& reader) {
  OutputPlan outputs;
  outputs.files = get_texts(reader);
  outputs.tone = reader.get_text();
  outputs.tone_settings = get_texts(reader);
  for (bool* flag : {&outputs.denoise, &outputs.full_float, &outputs.reproducible})
    *flag = reader.get_flag();
  return outputs;
}

void put_view(BinaryWriter& writer, const ViewFacts& view) {
  writer.put_text(view.integrator);
  writer.put(view.horizontal_fov);
  writer.put(view.vertical_fov);
  writer.put(uint8_t(view.quantity == Quantity::irradiance));
  writer.put(view.exposure);
  for (const int number : {view.frame.width, view.frame.height, view.frame.x, view.frame.y})
    writer.put(int32_t(number));
}

ViewFacts get_view(BinaryReader& reader) {
  ViewFacts view;
  view.integrator = reader.get_text();
  view.horizontal_fov = get_finite(reader);
  view.vertical_fov = get_finite(reader);
  view.quantity = reader.get_flag() ? Quantity::irradiance : Quantity::radiance;
  view.exposure = get_finite(reader);
  for (int* number : {&view.frame.width, &view.frame.height, &view.frame.x, &view.frame.y})
    *number = reader.get<int32_t>();
  return view;
}

/// A window of that size lies in the frame, which may be absent.
bool is_valid(const PictureFrame& frame, const Vec2i& size) {
  if (frame == PictureFrame{}) return true;
  return frame.x >= 0 && frame.y >= 0 && frame.width <= max_image_pixels &&
         frame.height <= max_image_pixels && size.x <= int64_t(frame.width) - frame.x &&
         size.y <= int64_t(frame.height) - frame.y;
}

RenderRecord get_record(BinaryReader& reader) {
  RenderRecord record;
  record.program = reader.get_text();
  record.recipe = get_recipe(reader);
  record.plan = get_plan(reader);
  record.outputs = get_outputs(reader);
  record.view = get_view(reader);
  record.seconds = get_finite(reader);
  return record;
}

/// What tells two recipes apart, and how to make them alike; "" if nothing does.
std::pair<std::string, std::string> difference(const RenderRecipe& a, const RenderRecipe& b) {
  if (a.digest.scene != b.digest.scene)
    return {"another scene, or one that was changed",
            "render all parts of one scene file, with the same definitions and settings"};
  if (a.digest.integrator != b.digest.integrator)
    return {"another integrator, or other parameters of it",
            "render all parts by the same integrator with the same settings"};
  if (a.seed != b.seed)
    return {fmt::format("seed {} instead of {}", b.seed, a.seed),
            "render all parts with the same seed"};
  if (a.samples_per_pass != b.samples_per_pass)
    return {
        fmt::format("{} samples per pass instead of {}", b.samples_per_pass, a.samples_per_pass),
        "give the passes of all parts the same number of samples per pixel"};
  if (a.lessons != b.lessons) return {"other lessons", "give all parts the same lessons, or none"};
  return {};
}

/// From the first pass of either plan to the last pass of either.
StopPlan merged_plan(const StopPlan& a, const StopPlan& b, const PassSet& passes) {
  StopPlan plan;
  plan.first_pass = std::min(a.first_pass, b.first_pass);
  plan.passes = passes.ranges().back().end - plan.first_pass;
  return plan;
}

/// A part of a second that sums of times are exact in, in whatever order they are added.
double to_exact_part(double seconds) {
  return std::ldexp(std::round(std::ldexp(seconds, 20)), -20);
}

/// All but the plan, of the part whose passes begin first: so the order of merging makes no
/// difference. Parts that were to write different pictures leave open what the whole is to write.
RenderRecord merged_record(RenderRecord first, const RenderRecord& other) {
  if (first.outputs.files != other.outputs.files) first.outputs.files.clear();
  first.seconds = to_exact_part(first.seconds) + to_exact_part(other.seconds);
  return first;
}

}  // namespace

namespace {

void put_checkpoint(BinaryWriter& writer, const RenderRecord& record, const Film& film,
                    const Lessons& lessons) {
  writer.put_text(record.program);
  put_recipe(writer, record.recipe);
  put_plan(writer, record.plan);
  put_outputs(writer, record.outputs);
  put_view(writer, record.view);
  writer.put(record.seconds);
  put_lessons(writer, lessons);
  film.write(writer);
}

}  // namespace

std::vector<uint8_t> checkpoint_bytes(const RenderRecord& record, const Film& film,
                                      const Lessons& lessons) {
  BinaryWriter writer(checkpoint_kind);
  put_checkpoint(writer, record, film, lessons);
  return writer.finished();
}

void write_checkpoint(const std::string& path, const RenderRecord& record, const Film& film,
                      const Lessons& lessons) try {
  BinaryWriter writer(checkpoint_kind);
  put_checkpoint(writer, record, film, lessons);
  writer.write_to(path);
} catch (const std::bad_alloc&) {
  throw Error(ErrorKind::system, fmt::format("cannot write '{}': not enough memory", path),
              "render the picture in parts by the film's crop window, or where there is more");
}

namespace {

Checkpoint get_checkpoint(BinaryReader& reader) {
  RenderRecord record = get_record(reader);
  Lessons lessons = get_lessons(reader);
  Checkpoint checkpoint{std::move(record), Film::read(reader), std::move(lessons)};
  reader.expect_end();
  if (checkpoint.record.recipe.lessons != 0 &&
      checkpoint.record.recipe.lessons != digest_of(checkpoint.lessons))
    reader.damaged("its lessons are not those of its passes");
  const Film& film = checkpoint.film;
  const PassSet& passes = film.passes();
  if (!is_valid(checkpoint.record.view.frame, {film.width(), film.height()}))
    reader.damaged("the frame of its picture is not valid");
  if (passes.empty()) reader.damaged("it holds no pass");
  if (film.samples_per_pixel() !=
      uint64_t(film.pass_count()) * checkpoint.record.recipe.samples_per_pass)
    reader.damaged("its passes do not have the samples that it tells");
  for (const FilmRegion& region : film.regions())
    if (region.film.samples_per_pixel() !=
        uint64_t(region.film.pass_count()) * checkpoint.record.recipe.samples_per_pass)
      reader.damaged("the passes of its regions do not have the samples that it tells");
  if (checkpoint.record.plan.first_pass >= passes.ranges().back().end)
    reader.damaged("its passes come before those that it was to have");
  return checkpoint;
}

}  // namespace

Checkpoint read_checkpoint(const std::string& path) {
  BinaryReader reader(checkpoint_kind, path);
  return get_checkpoint(reader);
}

Checkpoint parse_checkpoint(std::vector<uint8_t> bytes, const std::string& name) {
  BinaryReader reader(checkpoint_kind, std::move(bytes), name);
  return get_checkpoint(reader);
}

bool is_checkpoint(const std::string& path) { return is_of_kind(checkpoint_kind, path); }

void merge_checkpoint(Checkpoint& whole, const std::string& whole_path, const Checkpoint& part,
                      const std::string& path) {
  const auto fail = [&](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy, place_in(path));
  };
  const auto [what, remedy] = difference(whole.record.recipe, part.record.recipe);
  if (!what.empty())
    fail(fmt::format("this cannot be merged with '{}': it has {}", whole_path, what), remedy);
  if (!whole.film.is_like(part.film))
    fail(fmt::format("this cannot be merged with '{}': its picture has another size or other "
                     "components",
                     whole_path),
         "render all parts of one scene file, with the same definitions and settings");
  const PassSet twice = whole.film.passes().common(part.film.passes());
  if (!twice.empty())
    fail(fmt::format("of its passes {} were given before: {}", part.film.passes().text(),
                     twice.text()),
         "give each pass once: parts have passes of their own");
  if (const PassSet regional = whole.film.twice_in_regions(part.film); !regional.empty())
    fail(fmt::format("of the passes of its regions {} were given before, for the same pixels",
                     regional.text()),
         "ask for more samples in a region of one part alone");
  const bool leads =
      part.film.passes().ranges().front().begin < whole.film.passes().ranges().front().begin;
  whole.film.add(part.film);
  // Of as many passes they may have been written at different times: one order of them for all.
  const auto order = [](const Lessons& lessons) { return std::tie(lessons.passes, lessons.bytes); };
  if (order(whole.lessons) < order(part.lessons)) whole.lessons = part.lessons;
  RenderRecord record =
      merged_record(leads ? part.record : whole.record, leads ? whole.record : part.record);
  record.plan = merged_plan(whole.record.plan, part.record.plan, whole.film.passes());
  whole.record = std::move(record);
}

}  // namespace kaustik
