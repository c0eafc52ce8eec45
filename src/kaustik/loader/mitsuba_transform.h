#pragma once
#include "kaustik/base/transform.h"
#include "kaustik/loader/mitsuba_element.h"
#include "kaustik/loader/mitsuba_upgrade.h"

namespace kaustik::mitsuba {

/// The attributes of an element in <transform>.
AttributeRule transform_rule(const Element& element, Version version);

/// What old cameras do first: the left of their picture was the right of today's.
Transform mirrored_camera();

/// translate, rotate, scale, lookat or matrix; a lookat with 'ox' is of before 0.3. A scale and a
/// matrix may collapse space where that is allowed. Throws BadValue.
Transform parse_transform_operation(const Element& element, bool may_collapse);

/// A <rotate> whose axis is zero. Throws BadValue.
bool turns_nothing(const Element& element);

/// First `first`, then `next`. Throws BadValue where the result has numbers that are not finite.
Transform followed_by(const Transform& first, const Transform& next);

}  // namespace kaustik::mitsuba
