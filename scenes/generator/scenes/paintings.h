#pragma once
#include "kit/scene_folder.h"

namespace kaustik::scenes {

/// A picture in a gilded frame.
struct Painting {
  std::string name;
  Picture (*paint)(int width, int height, uint64_t seed);
  double width, height;  ///< of the canvas, m
  Vec3d center;     ///< on the wall; of one that leans: on the floor, below the middle of its back
  double turn;      ///< of where it faces, about z: 0 faces -y, 90 faces +x
  double lean = 0;  ///< degrees by which its top lies back; it then stands on the floor
};

/// How far from the wall a leaning picture's back edge must stand for its top to touch it.
double foot_of_leaning(const Painting& painting);

/// Adds canvases and frames; the frames' material is "gold".
void add_paintings(SceneFolder& scene, const std::vector<Painting>& paintings, uint64_t seed);

}  // namespace kaustik::scenes
