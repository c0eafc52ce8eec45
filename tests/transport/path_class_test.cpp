// Every light path has one owner, whichever end it is followed from.

#include "kaustik/transport/path_class.h"

#include <gtest/gtest.h>

#include <vector>

namespace kaustik {
namespace {

/// Stands for scattering in a medium among the lobes.
constexpr Lobes in_medium = Lobes::none;

/// Events in the order in which light meets them.
using Events = std::vector<Lobes>;

/// All sequences of `length` events.
std::vector<Events> sequences(int length) {
  std::vector<Events> result = {{}};
  for (int i = 0; i < length; ++i) {
    std::vector<Events> longer;
    for (const Events& events : result)
      for (const Lobes event : {Lobes::diffuse, Lobes::glossy, Lobes::delta, in_medium}) {
        longer.push_back(events);
        longer.back().push_back(event);
      }
    result = std::move(longer);
  }
  return result;
}

/// The definition in component.h, word for word.
Component owner(const Events& events, Lobes traced) {
  const auto is_specular = [&](Lobes event) { return any(event & traced); };
  if (events.empty()) return Component::emission;
  const Lobes last = events.back();  // where the camera's path is scattered first
  if (last == in_medium) return Component::volume;
  if (events.size() == 1) return last == Lobes::delta ? Component::specular : Component::direct;
  if (is_specular(last)) return Component::specular;
  for (size_t i = 0; i + 1 < events.size(); ++i)
    if (!is_specular(events[i])) return Component::indirect;
  return Component::caustic;
}

std::string name_of(const Events& events) {
  std::string name = "L";
  for (const Lobes event : events)
    name += event == Lobes::diffuse  ? " diffuse"
            : event == Lobes::glossy ? " glossy"
            : event == Lobes::delta  ? " delta"
                                     : " medium";
  return name;
}

/// Adds an event to a path from either end.
template <typename PathClass>
void add(PathClass& path, Lobes event) {
  if (event == in_medium)
    path.add_medium_event();
  else
    path.add_event(event);
}

/// By trying all that may follow, up to three events.
bool may_find(const Events& events, Lobes traced, Component wanted) {
  for (int more = 0; more <= 3; ++more)
    for (const Events& before : sequences(more)) {
      Events all = before;  // light meets first what the camera's path meets last
      all.insert(all.end(), events.begin(), events.end());
      if (owner(all, traced) == wanted) return true;
    }
  return false;
}

template <typename Check>
void for_all_paths(const Check& check) {
  for (const Lobes traced : {Lobes::specular, Lobes::delta})
    for (int length = 0; length <= 4; ++length)
      for (const Events& events : sequences(length)) {
        SCOPED_TRACE(name_of(events) + (traced == Lobes::delta ? ", delta traced" : ""));
        check(events, traced);
      }
}

CameraPathClass camera_path(const Events& events, Lobes traced) {
  CameraPathClass path(traced);
  for (auto event = events.rbegin(); event != events.rend(); ++event) add(path, *event);
  return path;
}

TEST(PathClass, CameraPathsFollowTheDefinition) {
  int paths = 0;
  for_all_paths([&](const Events& events, Lobes traced) {
    EXPECT_EQ(camera_path(events, traced).component(), owner(events, traced));
    ++paths;
  });
  EXPECT_EQ(paths, 2 * (1 + 4 + 16 + 64 + 256));
}

TEST(PathClass, AskingAheadIsTheSameAsGoingOn) {
  for_all_paths([&](const Events& events, Lobes traced) {
    if (events.empty()) return;
    const CameraPathClass before = camera_path({events.begin() + 1, events.end()}, traced);
    EXPECT_EQ(events.front() == in_medium ? before.component_in_medium()
                                          : before.component_after(events.front()),
              owner(events, traced));
  });
}

TEST(PathClass, LightPathsAgreeWithCameraPaths) {
  for_all_paths([&](const Events& events, Lobes traced) {
    // Nothing can be connected to the camera through a delta lobe.
    if (events.empty() || events.back() == Lobes::delta) return;
    LightPathClass path(traced);
    for (size_t i = 0; i + 1 < events.size(); ++i) add(path, events[i]);
    // What the camera sees in a medium is a component of its own, whatever came before.
    if (events.back() == in_medium) return;
    EXPECT_EQ(path.component_seen_by(events.back()), camera_path(events, traced).component());
  });
}

TEST(PathClass, CausticPhotonsAreThoseOfCausticPaths) {
  for_all_paths([&](const Events& events, Lobes traced) {
    LightPathClass path(traced);
    int diffuse = 0;
    for (const Lobes event : events) {
      add(path, event);
      diffuse += any(event & traced) ? 0 : 1;
    }
    EXPECT_EQ(path.events(), int(events.size()));
    EXPECT_EQ(path.diffuse_events(), diffuse);
    // What a diffuse surface sends of L G⁺ to the camera is the caustic component.
    if (!events.empty() && diffuse == 0) {
      EXPECT_EQ(path.component_seen_by(Lobes::diffuse), Component::caustic);
    }
  });
}

TEST(ComponentSet, HoldsWhatWasAdded) {
  ComponentSet set;
  EXPECT_TRUE(set.empty());
  set.add(Component::caustic);
  set.add(Component::emission);
  for (int i = 0; i < component_count; ++i) {
    const auto c = Component(i);
    EXPECT_EQ(set.has(c), c == Component::caustic || c == Component::emission);
    EXPECT_TRUE(ComponentSet::all().has(c));
  }
}

TEST(CameraPathClass, KnowsWhatMayStillBeFound) {
  for_all_paths([](const Events& events, Lobes traced) {
    for (int i = 0; i < component_count; ++i) {
      ComponentSet wanted;
      wanted.add(Component(i));
      EXPECT_EQ(camera_path(events, traced).may_find(wanted),
                may_find(events, traced, Component(i)))
          << component_names[size_t(i)];
    }
  });
}

}  // namespace
}  // namespace kaustik
