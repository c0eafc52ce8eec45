#pragma once
#include "kaustik/image/image.h"
#include "kaustik/scene/scene.h"

namespace kaustik::thesis {

/// Photons as points: every one that the camera sees is a dot in its colour, over a dim picture of
/// the scene's surfaces.
class PhotonPicture {
 public:
  /// `first_hits`: a picture of the scene with the layers "albedo" and "N".
  PhotonPicture(const Scene& scene, const Image& first_hits);
  /// A photon at `position`; nothing if something stands before it.
  void add(const Vec3f& position, const Vec3f& color);
  const Image& image() const { return image_; }

 private:
  const Scene& scene_;
  Image image_;
};

}  // namespace kaustik::thesis
