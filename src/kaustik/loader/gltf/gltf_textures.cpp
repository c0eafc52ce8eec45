#include "kaustik/loader/gltf/gltf_textures.h"

#include <fmt/format.h>

#include <cmath>

#include "kaustik/base/array.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/stand_ins.h"

namespace kaustik::gltf {
namespace {

// Of samplers, as WebGL has them.
constexpr size_t nearest_filter = 9728, clamp_wrap = 33071, mirrored_wrap = 33648;

const char* wrap_mode(size_t code) {
  return code == clamp_wrap ? "clamp" : code == mirrored_wrap ? "mirror" : "repeat";
}

const char* channel_of(TextureUse use) {
  switch (use) {
    case TextureUse::red:
      return "r";
    case TextureUse::green:
      return "g";
    case TextureUse::blue:
      return "b";
    case TextureUse::opacity:
      return "a";
    default:
      return nullptr;
  }
}

/// KTX2 begins so, of which no picture can be read here.
bool is_ktx(const Bytes& picture) {
  constexpr std::string_view mark = "\xabKTX";
  const std::string_view text(reinterpret_cast<const char*>(picture.bytes.data()),
                              picture.bytes.size());
  return text.starts_with(mark);
}

}  // namespace

size_t Textures::uv_set(const JsonValue& info) const {
  const size_t own = file_.count(info, "texCoord").value_or(0);
  const JsonValue* transform = file_.extension(info, "KHR_texture_transform");
  return transform ? file_.count(*transform, "texCoord").value_or(own) : own;
}

std::shared_ptr<Object> Textures::texture(const JsonValue& info, TextureUse use) {
  auto [entry, is_new] = known_.try_emplace({&info, use});
  if (!is_new) return entry->second;
  const JsonValue* texture = file_.referred(info, "index", "textures");
  if (!texture) file_.fail(info, "this names no texture", "give an 'index'");
  const size_t texture_index = *file_.count(info, "index");
  const std::string name = file_.name_of("texture", *texture, texture_index);
  auto bitmap = make_object("texture", "bitmap", file_.place(info));
  const std::optional<size_t> image = image_of(*texture);
  const std::string missing =
      image ? give_picture(*bitmap, file_.item("images", *image, *texture), *image)
            : "it has no picture of a format that can be read";
  if (!missing.empty()) {
    deviations_.missing(name, missing, file_.place(*texture));
    return entry->second = stand_in(info, use);
  }
  if (use != TextureUse::color) give(*bitmap, "raw", true);
  if (const char* channel = channel_of(use)) give(*bitmap, "channel", channel);
  give_sampler(*bitmap, *texture);
  give_transform(*bitmap, info);
  return entry->second = bitmap;
}

std::shared_ptr<Object> Textures::stand_in(const JsonValue& info, TextureUse use) const {
  return use == TextureUse::color ? missing_texture(file_.place(info)) : nullptr;
}

std::optional<size_t> Textures::image_of(const JsonValue& texture) const {
  for (const char* name : {"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu"}) {
    const JsonValue* extension = file_.extension(texture, name);
    const bool can_be_read = std::string_view(name) == "EXT_texture_webp";
    if (extension && can_be_read)
      if (const auto source = file_.count(*extension, "source")) return source;
  }
  return file_.count(texture, "source");
}

std::string Textures::give_picture(Object& bitmap, const JsonValue& image, size_t index) {
  if (const auto known = pictures_.find(index); known != pictures_.end()) {
    give(bitmap, "data", known->second);
    return {};
  }
  const std::string uri = file_.text(image, "uri", "");
  std::optional<Bytes> bytes = uri.empty() ? std::nullopt : file_.data_uri(uri, image);
  if (!uri.empty() && !bytes) return give_file(bitmap, uri, image);
  if (!bytes) {
    const auto view = file_.count(image, "bufferView");
    if (!view) return fmt::format("image {} has neither 'uri' nor 'bufferView'", index);
    try {
      bytes = file_.view(*view, image);
    } catch (const MissingData& missing) {
      return missing.what;
    }
  }
  if (bytes->bytes.empty()) return fmt::format("image {} is empty", index);
  if (is_ktx(*bytes)) return fmt::format("image {} is KTX2, which cannot be read", index);
  const auto picture =
      Array::borrow(ElementType::uint8, {bytes->bytes.size()}, bytes->bytes, bytes->owner);
  pictures_[index] = picture;
  give(bitmap, "data", picture);
  return {};
}

std::string Textures::give_file(Object& bitmap, const std::string& uri, const JsonValue& image) {
  const auto path = file_.find(uri, image);
  if (!path) return fmt::format("there is no file '{}'", uri.substr(0, 200));
  if (path->extension() == ".ktx2") return fmt::format("'{}' cannot be read", path->string());
  bitmap.properties.push_back({"filename", path->string(), file_.place(image)});
  return {};
}

void Textures::give_sampler(Object& bitmap, const JsonValue& texture) const {
  const JsonValue* sampler = file_.referred(texture, "sampler", "samplers");
  if (!sampler) return;
  const auto wrap = [&](const char* member, const char* parameter) {
    const auto code = file_.count(*sampler, member);
    if (code && (*code == clamp_wrap || *code == mirrored_wrap))
      give(bitmap, parameter, wrap_mode(*code));
  };
  wrap("wrapS", "wrap_mode_u");
  wrap("wrapT", "wrap_mode_v");
  if (file_.count(*sampler, "magFilter") == nearest_filter) give(bitmap, "filter_type", "nearest");
}

/// Scale, then rotation, then offset. The rotation is anticlockwise as one looks at the picture,
/// whose v runs downwards, as the viewers of the Khronos Group do it.
void Textures::give_transform(Object& bitmap, const JsonValue& info) const {
  const JsonValue* transform = file_.extension(info, "KHR_texture_transform");
  if (!transform) return;
  const std::vector<double> offset = file_.numbers(*transform, "offset", {0, 0});
  const std::vector<double> scale = file_.numbers(*transform, "scale", {1, 1});
  const double angle = file_.number(*transform, "rotation", 0);
  const double c = std::cos(angle), s = std::sin(angle);
  const double rows[4][4] = {{c * scale[0], s * scale[1], 0, offset[0]},
                             {-s * scale[0], c * scale[1], 0, offset[1]},
                             {0, 0, 1, 0},
                             {0, 0, 0, 1}};
  try {
    const Transform to_uv =
        scale[0] != 0 && scale[1] != 0 ? Transform(rows) : Transform::collapsing(rows);
    if (!(to_uv == Transform())) give(bitmap, "to_uv", to_uv);
  } catch (const std::invalid_argument&) {
    file_.fail(*transform, "the transform of the texture is out of range", "give smaller numbers");
  }
}

}  // namespace kaustik::gltf
