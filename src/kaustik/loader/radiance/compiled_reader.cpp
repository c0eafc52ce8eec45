#include "kaustik/loader/radiance/compiled_reader.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

constexpr size_t longest_header = 1 << 16;

/// Behind the empty line that ends it.
size_t end_of_header(std::string_view bytes) {
  const size_t end = bytes.substr(0, longest_header).find("\n\n");
  return end == std::string_view::npos ? bytes.size() : end + 2;
}

}  // namespace

bool is_compiled(std::string_view bytes, std::string_view format) {
  if (!bytes.starts_with("#?")) return false;
  const std::string_view header = bytes.substr(0, end_of_header(bytes));
  const size_t at = header.find("\nFORMAT=");
  return at != std::string_view::npos && header.substr(at + 8).starts_with(format);
}

CompiledReader::CompiledReader(std::string_view bytes, Place place)
    : bytes_(bytes), place_(std::move(place)), at_(end_of_header(bytes)) {}

void CompiledReader::refuse() const {
  throw Error(
      ErrorKind::input, "the compiled file is damaged, or of an unknown version",
      "let Radiance make it again (oconv, obj2mesh), or load the text that it was made from",
      place_);
}

int64_t CompiledReader::integer(int size) {
  if (left() < size_t(size)) refuse();
  uint64_t value = (uint8_t(bytes_[at_]) & 0x80) != 0 ? ~uint64_t{0} : 0;
  for (int i = 0; i < size; ++i) value = value << 8 | uint8_t(bytes_[at_++]);
  return int64_t(value);
}

size_t CompiledReader::count(int size, size_t bytes_each) {
  const int64_t value = integer(size);
  if (value < 0 || uint64_t(value) > left() / bytes_each) refuse();
  return size_t(value);
}

double CompiledReader::number() {
  const int64_t mantissa = integer(4), exponent = integer(1);
  if (mantissa == 0) return 0;
  return std::ldexp((double(mantissa) + (mantissa > 0 ? 0.5 : -0.5)) / 0x7fffffff, int(exponent));
}

std::string CompiledReader::text() {
  const size_t end = bytes_.find('\0', at_);
  if (end == std::string_view::npos) refuse();
  std::string text(bytes_.substr(at_, end - at_));
  at_ = end + 1;
  return text;
}

void CompiledReader::read_format(int magic) {
  object_size_ = int(std::clamp<int64_t>(integer(2) - magic, -1, 9));
  if (object_size_ < 1 || object_size_ > 8) refuse();
}

void CompiledReader::read_cube(Vec3d& corner, double& size) {
  double numbers[4];
  for (double& number : numbers) {
    const std::string text = this->text();
    const size_t begin = std::min(text.find_first_not_of(' '), text.size());
    const auto value = number_of(std::string_view(text).substr(begin));
    if (!value) refuse();
    number = *value;
  }
  corner = {numbers[0], numbers[1], numbers[2]};
  size = numbers[3];
}

void CompiledReader::skip_tree() {
  constexpr int64_t empty = 0, full = 1, tree = 2;
  for (size_t open = 1; open > 0; --open) {
    const int64_t kind = integer(1);
    if (kind == full) {
      at_ += count(object_size_, size_t(object_size_)) * size_t(object_size_);
    } else if (kind == tree) {
      open += 8;
    } else if (kind != empty) {
      refuse();
    }
  }
}

/// False behind the last one.
bool CompiledReader::read_object(const std::vector<std::string>& types, Statements& found) {
  const int64_t type = integer(1);
  if (type == -1) return false;
  if (type < 0 || size_t(type) >= types.size()) refuse();
  const int64_t modifier = integer(object_size_);
  if (modifier < -1 || modifier >= int64_t(found.size())) refuse();
  Primitive made;
  made.place = place_;
  made.type = types[size_t(type)];
  made.modifier = modifier < 0 ? "void" : std::get<Primitive>(found[size_t(modifier)]).id;
  made.id = text();
  for (size_t left = count(2, 1); left > 0; --left) made.strings.push_back(text());
  for (size_t left = count(2, 5); left > 0; --left) made.reals.push_back(number());
  // An alias without a string stands for its modifier.
  if (made.type == "alias" && made.strings.empty()) {
    made.strings = {made.modifier};
    made.modifier = "inherit";
  }
  found.emplace_back(std::move(made));
  return true;
}

Statements CompiledReader::read_objects() {
  std::vector<std::string> types;
  for (std::string type = text(); !type.empty(); type = text()) types.push_back(std::move(type));
  Statements found;
  while (read_object(types, found)) {
  }
  return found;
}

CompiledOctree read_octree(std::string_view bytes, const Place& place) {
  constexpr int magic = 283;  // of format 4
  CompiledReader reader(bytes, place);
  reader.read_format(magic);
  Vec3d corner;
  double size = 0;
  reader.read_cube(corner, size);
  CompiledOctree octree;
  for (std::string file = reader.text(); !file.empty(); file = reader.text())
    octree.files.push_back(std::move(file));
  if (!octree.files.empty()) return octree;
  reader.object_number();  // how many there are
  reader.skip_tree();
  octree.statements = reader.read_objects();
  return octree;
}

}  // namespace kaustik::radiance
