#include "kaustik/loader/nori/cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/mitsuba_transform.h"
#include "kaustik/loader/object_maker.h"

namespace kaustik::nori {
namespace {

std::shared_ptr<Object> filter_of(const Object* element, const Place& place, Reading& reading) {
  if (!element) return make_object("rfilter", reading.has_box_filter ? "box" : "gaussian", place);
  Given given(*element, reading.deviations);
  auto filter = make_object("rfilter", element->type, element->place);
  const auto radius = given.number({"radius"});
  const auto deviation = given.number({"stddev"}), b = given.number({"b"}), c = given.number({"c"});
  if (element->type == "gaussian") {
    const double stddev = deviation.value_or(0.5);
    give(*filter, "stddev", stddev);
    if (std::fabs(radius.value_or(2) - 4 * stddev) > 1e-3)
      reading.approximated(*element, "it ends at four standard deviations");
  } else if (element->type == "mitchell") {
    if (b) give(*filter, "B", *b);
    if (c) give(*filter, "C", *c);
  } else if (element->type != "tent" && element->type != "box") {
    reading.approximated(*element, "there is no such filter here: it is a Gaussian");
    filter->type = "gaussian";
  }
  return reading.has_box_filter ? make_object("rfilter", "box", place) : filter;
}

std::shared_ptr<Object> film_of(Given& given, Reading& reading) {
  const Object& element = given.element();
  auto film = make_object("film", "hdrfilm", element.place);
  give(*film, "width", given.count({"width"}, 1280, 1));
  give(*film, "height", given.count({"height"}, 720, 1));
  const Object* filter = nullptr;
  for (const Child& child : element.children)
    if (!filter && child.object->family == "rfilter") filter = child.object.get();
  reading.ignore_parts(element, {filter});
  put(*film, "", filter_of(filter, element.place, reading));
  return film;
}

double field_of_view(Given& given, Reading& reading) {
  constexpr double least = 1e-4, most = 179.9;
  const double wanted = given.number({"fov"}).value_or(30);
  const double fov = std::clamp(wanted, least, most);
  if (fov != wanted)
    reading.approximated(given.element(), fmt::format("its field of view is {} degrees", fov));
  return fov;
}

/// A lens, where one is given: by its radius, or by its focal length over the f-number.
void give_lens(Object& sensor, Given& given) {
  const auto distance = given.number({"focusdistance", "focaldistance", "focallength"});
  auto radius = given.number({"lensradius", "apertureradius", "aperture"});
  if (!radius || *radius <= 0) return;
  sensor.type = "thinlens";
  give(sensor, "aperture_radius", *radius);
  if (distance) give(sensor, "focus_distance", *distance);
}

}  // namespace

std::shared_ptr<Object> sensor_of(const Object& element, const Object* sampler, Reading& reading) {
  Given given(element, reading.deviations);
  auto sensor = make_object("sensor", "perspective", element.place);
  if (element.type != "perspective" && element.type != "thinlens")
    reading.approximated(element, "there is no such camera here: it is a perspective one");
  // Nori's +x points to the right of the picture, Kaustik's to the left.
  give(*sensor, "to_world",
       given.transform({"toworld"}).value_or(Transform()) * mitsuba::mirrored_camera());
  give(*sensor, "fov", field_of_view(given, reading));
  give(*sensor, "fov_axis", "x");
  if (const auto near = given.number({"nearclip"})) give(*sensor, "near_clip", *near);
  if (const auto far = given.number({"farclip"})) give(*sensor, "far_clip", *far);
  give_lens(*sensor, given);
  put(*sensor, "", film_of(given, reading));
  auto samples = make_object("sampler", "independent", sampler ? sampler->place : element.place);
  if (sampler) {
    Given of_sampler(*sampler, reading.deviations);
    give(*samples, "sample_count", of_sampler.count({"samplecount"}, 1, 1));
  } else {
    give(*samples, "sample_count", int64_t{1});
  }
  put(*sensor, "", std::move(samples));
  return sensor;
}

}  // namespace kaustik::nori
