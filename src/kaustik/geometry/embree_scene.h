#pragma once
// Embree's acceleration structures; only for ray_tracer.cpp.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// A device of Embree, shared by the structures that were built with it. They are built one after
/// another; tracing in those that are finished goes on meanwhile.
class EmbreeDevice {
 public:
  /// Throws Error(system) if Embree cannot start.
  EmbreeDevice();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }
  /// Throws what Embree has told since then, as an Error(system).
  void check();
  /// Whether something has failed. Taking Embree down where it could not start all its threads ends
  /// the program, and whether it could is not told: such a device is left behind, and so are its
  /// structures. Nothing more can be built with it.
  bool has_failed() const { return has_failed_; }
  /// Held while a structure is built or released.
  std::recursive_mutex& mutex() { return mutex_; }
  /// That it holds.
  int64_t bytes() const { return bytes_; }

 private:
  static void on_error(void* self, RTCError code, const char* text);
  static bool on_memory(void* self, ssize_t bytes, bool);

  RTCDevice device_ = nullptr;
  std::recursive_mutex mutex_;  ///< a thread that waits for one structure may release another
  std::mutex error_mutex_;
  std::atomic<int64_t> bytes_{0};
  std::atomic<bool> has_failed_{false};
  RTCError error_code_ = RTC_ERROR_NONE;
  std::string error_text_;
};

/// A structure over shapes, and over other structures that are placed in it. Immutable; keeps alive
/// all that it refers to.
class EmbreeScene {
 public:
  /// `columns`: of the matrix that places the structure, three of its linear part and the
  /// translation.
  struct Placement {
    std::shared_ptr<const EmbreeScene> scene;
    std::array<float, 12> columns;
    friend bool operator==(const Placement&, const Placement&) = default;
  };
  using Shapes = std::vector<std::shared_ptr<const Shape>>;

  /// Throws Error(system) if Embree runs out of memory.
  EmbreeScene(std::shared_ptr<EmbreeDevice> device, Shapes shapes,
              std::vector<Placement> placements);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_; }
  const std::shared_ptr<EmbreeDevice>& device() const { return device_; }
  /// Whether it would be built of the same again.
  bool is_of(const Shapes& shapes, const std::vector<Placement>& placements) const {
    return shapes_ == shapes && placements_ == placements;
  }
  /// Without the shapes themselves.
  int64_t bytes() const { return bytes_; }

 private:
  void build();
  void attach(RTCGeometry part);
  RTCGeometry mesh_geometry(const TriangleMesh& mesh);
  RTCGeometry user_geometry(const Shape& shape);
  RTCGeometry instance_geometry(const Placement& placement);

  std::shared_ptr<EmbreeDevice> device_;
  Shapes shapes_;
  std::vector<Placement> placements_;
  RTCScene scene_ = nullptr;
  int64_t bytes_ = 0;
};

}  // namespace kaustik
