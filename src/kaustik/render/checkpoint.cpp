// docs/reference/checkpoint_file.md describes the file; what is put and got here is that, in its
// order.
#include "kaustik/render/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "kaustik/base/binary_file.h"
#include "kaustik/render/lessons_file.h"

namespace kaustik {
namespace {

constexpr BinaryFileKind checkpoint_kind = {{0x89, 'K', 'P', 'T', '\r', '\n', 0x1a, '\n'},
                                            18,
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
  writer.put_text(recipe.points);
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
  recipe.points = reader.get_text();
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
  for (const uint32_t number :
       {plan.division.whole.begin, plan.division.whole.end, plan.division.parts})
    writer.put(number);
}

/// Either nothing is divided, or the plan is of some parts of a whole.
bool is_valid(const PassDivision& division, const StopPlan& plan) {
  if (!division.is_divided()) return division == PassDivision{};
  const PassRange& whole = division.whole;
  return whole.begin < whole.end && whole.end <= pass_limit &&
         division.parts <= std::min(whole.end - whole.begin, PassPart::maximum_count) &&
         plan.first_pass >= whole.begin && plan.passes > 0 &&
         plan.first_pass + plan.passes <= whole.end;
}

StopPlan get_plan(BinaryReader& reader) {
  StopPlan plan;
  plan.first_pass = reader.get<uint32_t>();
  plan.passes = reader.get<uint32_t>();
  if (plan.first_pass >= pass_limit || plan.passes > pass_limit - plan.first_pass)
    reader.damaged("the passes that it was to have are not valid");
  plan.seconds = get_optional(reader);
  plan.error = get_optional(reader);
  for (uint32_t* number :
       {&plan.division.whole.begin, &plan.division.whole.end, &plan.division.parts})
    *number = reader.get<uint32_t>();
  if (!is_valid(plan.division, plan)) reader.damaged("the parts of its passes are not valid");
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
  for (std::string& set : get_texts(reader)) record.instruction_sets.insert(std::move(set));
  record.recipe = get_recipe(reader);
  record.plan = get_plan(reader);
  record.outputs = get_outputs(reader);
  record.view = get_view(reader);
  record.seconds = get_finite(reader);
  return record;
}

void put_checkpoint(BinaryWriter& writer, const RenderRecord& record, const Film& film,
                    const Lessons& lessons) {
  writer.put_text(record.program);
  put_texts(writer, {record.instruction_sets.begin(), record.instruction_sets.end()});
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
                      const Lessons& lessons) {
  write_checkpoint_if(path, record, film, lessons, {});
}

bool write_checkpoint_if(const std::string& path, const RenderRecord& record, const Film& film,
                         const Lessons& lessons, const std::function<bool()>& is_wanted) try {
  BinaryWriter writer(checkpoint_kind);
  put_checkpoint(writer, record, film, lessons);
  if (is_wanted) return writer.write_to_if(path, is_wanted);
  writer.write_to(path);
  return true;
} catch (const std::bad_alloc&) {
  throw Error(ErrorKind::system, fmt::format("cannot write '{}': not enough memory", path),
              "render the picture in parts by the film's crop window, or where there is more");
}

CheckpointReader::CheckpointReader(const std::string& path, FileCheck check)
    : reader_(checkpoint_kind, path, check) {
  read_head();
}

CheckpointReader::CheckpointReader(std::vector<uint8_t> bytes, const std::string& name)
    : reader_(checkpoint_kind, std::move(bytes), name) {
  read_head();
}

void CheckpointReader::read_head() {
  record_ = get_record(reader_);
  lessons_ = get_lessons(reader_);
  film_head_ = Film::read_head(reader_);
  const RenderRecipe& recipe = record_.recipe;
  if (recipe.lessons != 0 && recipe.lessons != digest_of(lessons_))
    reader_.damaged("its lessons are not those of its passes");
  if (!is_valid(record_.view.frame, film_head_.size))
    reader_.damaged("the frame of its picture is not valid");
  const PassSet& passes = film_head_.passes;
  if (passes.empty()) reader_.damaged("it holds no pass");
  if (film_head_.samples_per_pixel != uint64_t(passes.count()) * recipe.samples_per_pass)
    reader_.damaged("its passes do not have the samples that it tells");
  if (record_.plan.first_pass >= passes.ranges().back().end)
    reader_.damaged("its passes come before those that it was to have");
}

void CheckpointReader::check_regions(const Film& film) const {
  for (const FilmRegion& region : film.regions())
    if (region.film.samples_per_pixel() !=
        uint64_t(region.film.pass_count()) * record_.recipe.samples_per_pass)
      reader_.damaged("the passes of its regions do not have the samples that it tells");
}

Film CheckpointReader::film() {
  Film film = Film::read(film_head_, reader_);
  reader_.expect_end();
  check_regions(film);
  return film;
}

PassSet CheckpointReader::add_film_to(Film& whole) {
  const PassSet twice = whole.add(film_head_, reader_);
  reader_.expect_end();
  check_regions(whole);
  return twice;
}

namespace {

Checkpoint get_checkpoint(CheckpointReader&& reader) {
  Film film = reader.film();
  return {reader.record(), std::move(film), reader.lessons()};
}

}  // namespace

Checkpoint read_checkpoint(const std::string& path) {
  return get_checkpoint(CheckpointReader(path));
}

Checkpoint parse_checkpoint(std::vector<uint8_t> bytes, const std::string& name) {
  return get_checkpoint(CheckpointReader(std::move(bytes), name));
}

bool is_checkpoint(const std::string& path) { return is_of_kind(checkpoint_kind, path); }

}  // namespace kaustik
