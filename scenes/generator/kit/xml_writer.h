#pragma once
// Mitsuba 3 scene files that people can read.

#include <string>
#include <utility>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik::scenes {

/// An element with its children, and a comment before it.
class Xml {
 public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  explicit Xml(std::string tag, Attributes attributes = {}, std::vector<Xml> children = {});

  Xml& add(Xml child);  ///< returns the child, until the next one is added
  Xml with(Xml child) &&;
  Xml said(std::string comment) &&;
  Xml named(const std::string& name) &&;  ///< with this name

  /// Indented by two spaces; an element with few plain children stands on one line where that
  /// fits 100 columns; comments are wrapped there. A comment at the first level starts a
  /// paragraph.
  std::string text() const;

 private:
  void write(std::string& out, int depth) const;
  std::string opening() const;
  bool fits_on_a_line(int depth) const;
  std::string on_a_line() const;

  std::string tag_;
  Attributes attributes_;
  std::vector<Xml> children_;
  std::string comment_;
};

/// `<family type="type" id="id">…</family>`; no id if empty.
Xml object(const std::string& family, const std::string& type, std::vector<Xml> children = {},
           const std::string& id = {});
Xml rgb(const std::string& name, const Vec3d& value);
Xml gray(const std::string& name, double value);  ///< the same for all wavelengths
Xml number(const std::string& name, double value);
Xml integer(const std::string& name, int value);
Xml text(const std::string& name, const std::string& value);
Xml boolean(const std::string& name, bool value);
Xml point(const std::string& name, const Vec3d& value);
Xml vector(const std::string& name, const Vec3d& value);
Xml ref(const std::string& id);
Xml named_ref(const std::string& name, const std::string& id);
/// A definition that the command line can change with -D.
Xml setting(const std::string& name, const std::string& value);

/// `<transform name="name">` of steps that apply one after the other.
Xml transform(std::vector<Xml> steps, const std::string& name = "to_world");
Xml translate(const Vec3d& offset);
Xml rotate(const Vec3d& axis, double degrees);
Xml scale(const Vec3d& factors);
Xml look_at(const Vec3d& origin, const Vec3d& target, const Vec3d& up = {0, 0, 1});

}  // namespace kaustik::scenes
