// The directives that change the current transform.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kaustik/loader/pbrt/directives.h"

namespace kaustik::pbrt {

Transform transform_of(const double (&rows)[4][4], const Place& place) {
  try {
    return Transform(rows);
  } catch (const std::invalid_argument&) {
  }
  try {
    return Transform::collapsing(rows);
  } catch (const std::invalid_argument&) {
    throw Error(ErrorKind::input, "the transform is singular, or beyond all numbers",
                "use less extreme factors", place);
  }
}

Transform camera_looking(const Vec3d& eye, const Vec3d& target, const Vec3d& up,
                         const Place& place) {
  const Vec3d ahead = (target - eye).normalized();
  const Vec3d right = up.cross(ahead).normalized();
  const Vec3d above = ahead.cross(right);
  if (!(ahead.length() > 0.5 && right.length() > 0.5))
    throw Error(ErrorKind::input, "LookAt leaves the camera no direction",
                "let eye and target differ, and 'up' point elsewhere than the line between them",
                place);
  const double world_from_camera[4][4] = {{right.x, above.x, ahead.x, eye.x},
                                          {right.y, above.y, ahead.y, eye.y},
                                          {right.z, above.z, ahead.z, eye.z},
                                          {0, 0, 0, 1}};
  return Transform(world_from_camera).inverse();
}

void Directives::read_numbers(const Call& call, double* numbers, size_t count) {
  std::vector<double> found;
  const bool has_bracket = call.tokens.peek().kind == TokenKind::open;
  if (has_bracket) call.tokens.next();
  while (found.size() < count) {
    const Token token = call.tokens.next();
    double number = 0;
    if (token.kind != TokenKind::word || !parse_number(token.text, number))
      throw Error(
          ErrorKind::input,
          fmt::format("{} has {} numbers, and needs {}", call.word.text, found.size(), count),
          "give the others", call.tokens.place_of(token));
    found.push_back(number);
  }
  if (has_bracket) {
    const Token token = call.tokens.next();
    if (token.kind != TokenKind::close)
      throw Error(ErrorKind::input,
                  fmt::format("{} has more than {} numbers, or no bracket behind them",
                              call.word.text, count),
                  "close them by a bracket", call.tokens.place_of(token));
  }
  std::copy(found.begin(), found.end(), numbers);
}

void Directives::apply(const Transform& change, bool replaces) {
  MovingTransform& at = state_.transform;
  if (state_.changes_start) at.start = replaces ? change : at.start * change;
  if (state_.changes_end) at.end = replaces ? change : at.end * change;
  if (state_.changes_start != state_.changes_end) at.is_moving = true;
}

void Directives::identity(const Call&) { apply({}, true); }

void Directives::translate(const Call& call) {
  double v[3];
  read_numbers(call, v, 3);
  apply(Transform::translate({v[0], v[1], v[2]}));
}

void Directives::scale(const Call& call) {
  double v[3];
  read_numbers(call, v, 3);
  const double rows[4][4] = {{v[0], 0, 0, 0}, {0, v[1], 0, 0}, {0, 0, v[2], 0}, {0, 0, 0, 1}};
  apply(transform_of(rows, call.place()));
}

void Directives::rotate(const Call& call) {
  double v[4];
  read_numbers(call, v, 4);
  const Vec3d axis(v[1], v[2], v[3]);
  if (!(axis.length() > 0)) {
    deviations_.ignored("Rotate", "it turns nothing: its axis is zero", call.place());
    return;
  }
  apply(Transform::rotate(axis, v[0]));
}

void Directives::look_at(const Call& call) {
  double v[9];
  read_numbers(call, v, 9);
  apply(camera_looking({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, call.place()));
}

namespace {

/// Sixteen numbers, column by column.
void rows_of(const double (&columns)[16], double (&rows)[4][4]) {
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j) rows[i][j] = columns[4 * j + i];
}

}  // namespace

void Directives::transform(const Call& call) {
  double columns[16], rows[4][4];
  read_numbers(call, columns, 16);
  rows_of(columns, rows);
  apply(transform_of(rows, call.place()), true);
}

void Directives::concat_transform(const Call& call) {
  double columns[16], rows[4][4];
  read_numbers(call, columns, 16);
  rows_of(columns, rows);
  apply(transform_of(rows, call.place()));
}

void Directives::coordinate_system(const Call& call) {
  coordinate_systems_[quoted(call, "a name")] = state_.transform;
}

void Directives::coord_sys_transform(const Call& call) {
  const std::string name = quoted(call, "a name");
  const auto known = coordinate_systems_.find(name);
  if (known != coordinate_systems_.end())
    state_.transform = known->second;
  else
    deviations_.ignored(fmt::format("coordinate system {}", shown(name)),
                        "it is not defined: the transform stays", call.place());
}

void Directives::active_transform(const Call& call) {
  const Token token = call.tokens.next();
  const bool is_start = token.text == "StartTime", is_end = token.text == "EndTime";
  if (token.kind != TokenKind::word || (!is_start && !is_end && token.text != "All"))
    throw Error(ErrorKind::input, "ActiveTransform has none of its words",
                "write StartTime, EndTime or All", call.tokens.place_of(token));
  state_.changes_start = !is_end;
  state_.changes_end = !is_start;
}

void Directives::transform_times(const Call& call) {
  double times[2];
  read_numbers(call, times, 2);
}

}  // namespace kaustik::pbrt
