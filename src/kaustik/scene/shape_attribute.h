#pragma once
#include <utility>

#include "kaustik/geometry/mesh_attribute.h"
#include "kaustik/material/texture.h"

namespace kaustik {

/// An attribute of a mesh as textures ask for it.
class ShapeAttribute final : public SurfaceAttribute {
 public:
  /// `shape` has a mesh, and `attribute` is one of it.
  ShapeAttribute(std::shared_ptr<const Shape> shape, const MeshAttribute& attribute)
      : shape_(std::move(shape)), mesh_(*shape_->mesh()), attribute_(attribute) {}

  Vec3f at(uint32_t primitive, const Vec3f& position) const override {
    return attribute_at(mesh_, attribute_, primitive, position);
  }
  Vec3f gradient(uint32_t primitive, const Vec3f& weights) const override {
    return attribute_gradient(mesh_, attribute_, primitive, weights);
  }
  Vec3f mean() const override { return attribute_mean(mesh_, attribute_); }
  float maximum() const override { return attribute_maximum(attribute_); }

 private:
  std::shared_ptr<const Shape> shape_;
  const TriangleMesh& mesh_;
  const MeshAttribute& attribute_;
};

/// Of a shape that has none of the name.
class NoAttribute final : public SurfaceAttribute {
 public:
  Vec3f at(uint32_t, const Vec3f&) const override { return {0, 0, 0}; }
  Vec3f gradient(uint32_t, const Vec3f&) const override { return {0, 0, 0}; }
  Vec3f mean() const override { return {0, 0, 0}; }
  float maximum() const override { return 0; }
};

}  // namespace kaustik
