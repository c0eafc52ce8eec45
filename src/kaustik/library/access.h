#pragma once
// What the opaque types of the interface hold.

#include <memory>
#include <mutex>
#include <optional>

#include "kaustik/base/array.h"
#include "kaustik/loader/load_options.h"
#include "kaustik/picture.h"
#include "kaustik/render/film.h"
#include "kaustik/scene.h"
#include "kaustik/scene/description.h"
#include "kaustik/scene/scene.h"

namespace kaustik::v0::details {

struct ArrayState {
  std::shared_ptr<const kaustik::Array> array;
};

struct ValueState {
  kaustik::Value value;
};

/// Objects that hold it count as its owners, too.
struct ObjectState : kaustik::Object {};

/// What was built last of a scene, or before that of the one that it was edited from: what is built
/// next shares with it. Thread-safe.
class BuiltScene {
 public:
  explicit BuiltScene(std::shared_ptr<const BuiltScene> before = nullptr)
      : before_(std::move(before)) {}
  /// Null: nothing was built.
  std::shared_ptr<const kaustik::Scene> get() const {
    const std::lock_guard lock(mutex_);
    return !scene_ && before_ ? before_->get() : scene_;
  }
  void put(std::shared_ptr<const kaustik::Scene> scene) {
    const std::lock_guard lock(mutex_);
    scene_ = std::move(scene);
    before_ = nullptr;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const kaustik::Scene> scene_;
  std::shared_ptr<const BuiltScene> before_;
};

struct SceneState {
  Description description;  ///< nobody changes it or its objects
  std::string file = {};    ///< that it is as it was read from; "": there is none
  kaustik::LoadOptions load = {};
  std::shared_ptr<BuiltScene> built = std::make_shared<BuiltScene>();
};

struct Access {
  static const kaustik::Value& value(const v0::Value& value) { return value.state_->value; }
  static v0::Value made(kaustik::Value value) {
    return v0::Value(std::make_shared<const ValueState>(ValueState{std::move(value)}));
  }
  static const std::shared_ptr<const kaustik::Array>& array(const v0::Array& array) {
    return array.state_->array;
  }
  static std::shared_ptr<kaustik::Object> object(const v0::Object& object) { return object.state_; }
  static void rename(v0::Object& object, std::string id) { object.own().id = std::move(id); }
  static const SceneState& scene(const v0::Scene& scene) { return *scene.state_; }
  static v0::Scene made(SceneState scene) {
    return v0::Scene(std::make_shared<const SceneState>(std::move(scene)));
  }
  /// `film` null: without errors.
  static v0::Picture picture(Image image, std::shared_ptr<const Film> film, uint32_t passes,
                             int threads);
};

}  // namespace kaustik::v0::details
