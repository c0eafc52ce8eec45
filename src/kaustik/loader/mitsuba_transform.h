#pragma once
#include "kaustik/base/transform.h"
#include "kaustik/loader/mitsuba_element.h"

namespace kaustik::mitsuba {

/// The attributes of an element in <transform>.
AttributeRule transform_rule(const std::string& operation);

/// translate, rotate, scale, lookat or matrix. Throws BadValue.
Transform parse_transform_operation(const Element& element);

/// First `first`, then `next`. Throws BadValue where the result has numbers that are not finite.
Transform followed_by(const Transform& first, const Transform& next);

}  // namespace kaustik::mitsuba
