#include "kit/xml_writer.h"

#include <fmt/format.h>

#include <sstream>

namespace kaustik::scenes {
namespace {

constexpr size_t columns = 100;

std::string digits(double x) { return fmt::format("{:.6g}", x + 0.0); }
std::string triple(const Vec3d& v) {
  return fmt::format("{}, {}, {}", digits(v.x), digits(v.y), digits(v.z));
}

std::string escaped(const std::string& value) {
  std::string out;
  for (const char c : value) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

/// `<!-- … -->`, wrapped, each line behind `margin`.
std::string wrapped_comment(const std::string& text, const std::string& margin) {
  std::istringstream words(text);
  std::string out = margin + "<!--", word;
  size_t width = out.size();
  while (words >> word) {
    if (width + 1 + word.size() + 4 > columns) {
      out += "\n" + margin + "    ";
      width = margin.size() + 4;
    }
    out += " " + word;
    width += 1 + word.size();
  }
  return out + " -->\n";
}

Xml property(const std::string& tag, const std::string& name, const std::string& value) {
  return Xml(tag, {{"name", name}, {"value", value}});
}

Xml xyz(const std::string& tag, const Vec3d& v) {
  return Xml(tag, {{"x", digits(v.x)}, {"y", digits(v.y)}, {"z", digits(v.z)}});
}

}  // namespace

Xml::Xml(std::string tag, Attributes attributes, std::vector<Xml> children)
    : tag_(std::move(tag)), attributes_(std::move(attributes)), children_(std::move(children)) {}

Xml& Xml::add(Xml child) {
  children_.push_back(std::move(child));
  return children_.back();
}

Xml Xml::with(Xml child) && {
  add(std::move(child));
  return std::move(*this);
}

Xml Xml::said(std::string comment) && {
  comment_ = std::move(comment);
  return std::move(*this);
}

Xml Xml::named(const std::string& name) && {
  std::erase_if(attributes_, [](const auto& attribute) { return attribute.first == "name"; });
  const bool has_type = !attributes_.empty() && attributes_[0].first == "type";
  attributes_.insert(attributes_.begin() + (has_type ? 1 : 0), {"name", name});
  return std::move(*this);
}

std::string Xml::opening() const {
  std::string out = "<" + tag_;
  for (const auto& [name, value] : attributes_) out += " " + name + "=\"" + escaped(value) + "\"";
  return out + (children_.empty() ? "/>" : ">");
}

std::string Xml::on_a_line() const {
  std::string out = opening();
  for (const Xml& child : children_) out += child.on_a_line();
  return children_.empty() ? out : out + "</" + tag_ + ">";
}

bool Xml::fits_on_a_line(int depth) const {
  if (children_.size() > 2) return false;
  for (const Xml& child : children_) {
    if (!child.comment_.empty() || child.children_.size() > 1) return false;
    for (const Xml& grandchild : child.children_)
      if (!grandchild.comment_.empty() || !grandchild.children_.empty()) return false;
  }
  return 2 * size_t(depth) + on_a_line().size() <= columns;
}

void Xml::write(std::string& out, int depth) const {
  const std::string margin(2 * size_t(depth), ' ');
  if (!comment_.empty()) out += (depth == 1 ? "\n" : "") + wrapped_comment(comment_, margin);
  if (children_.empty() || fits_on_a_line(depth)) {
    out += margin + on_a_line() + "\n";
    return;
  }
  out += margin + opening() + "\n";
  for (const Xml& child : children_) child.write(out, depth + 1);
  out += margin + "</" + tag_ + ">\n";
}

std::string Xml::text() const {
  std::string out = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
  write(out, 0);
  return out;
}

Xml object(const std::string& family, const std::string& type, std::vector<Xml> children,
           const std::string& id) {
  Xml::Attributes attributes = {{"type", type}};
  if (!id.empty()) attributes.emplace_back("id", id);
  return Xml(family, std::move(attributes), std::move(children));
}

Xml rgb(const std::string& name, const Vec3d& value) {
  return property("rgb", name, triple(value));
}
Xml gray(const std::string& name, double value) {
  return property("spectrum", name, digits(value));
}
Xml number(const std::string& name, double value) { return property("float", name, digits(value)); }
Xml integer(const std::string& name, int value) {
  return property("integer", name, fmt::format("{}", value));
}
Xml text(const std::string& name, const std::string& value) {
  return property("string", name, value);
}
Xml boolean(const std::string& name, bool value) {
  return property("boolean", name, value ? "true" : "false");
}
Xml point(const std::string& name, const Vec3d& v) {
  return Xml("point", {{"name", name}, {"x", digits(v.x)}, {"y", digits(v.y)}, {"z", digits(v.z)}});
}
Xml vector(const std::string& name, const Vec3d& v) {
  return Xml("vector",
             {{"name", name}, {"x", digits(v.x)}, {"y", digits(v.y)}, {"z", digits(v.z)}});
}
Xml ref(const std::string& id) { return Xml("ref", {{"id", id}}); }
Xml named_ref(const std::string& name, const std::string& id) {
  return Xml("ref", {{"name", name}, {"id", id}});
}
Xml setting(const std::string& name, const std::string& value) {
  return property("default", name, value);
}

Xml transform(std::vector<Xml> steps, const std::string& name) {
  return Xml("transform", {{"name", name}}, std::move(steps));
}
Xml translate(const Vec3d& offset) { return xyz("translate", offset); }
Xml rotate(const Vec3d& axis, double degrees) {
  return Xml("rotate", {{"x", digits(axis.x)},
                        {"y", digits(axis.y)},
                        {"z", digits(axis.z)},
                        {"angle", digits(degrees)}});
}
Xml scale(const Vec3d& factors) { return xyz("scale", factors); }
Xml look_at(const Vec3d& origin, const Vec3d& target, const Vec3d& up) {
  return Xml("lookat",
             {{"origin", triple(origin)}, {"target", triple(target)}, {"up", triple(up)}});
}

}  // namespace kaustik::scenes
