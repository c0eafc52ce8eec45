#include "kaustik/view/photon_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <utility>

#include "kaustik/render/photon_tracing.h"
#include "kaustik/scene/scene.h"
#include "kaustik/view/json_text.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

static_assert(std::endian::native == std::endian::little, "photons are sent as in memory");

constexpr int64_t most_photons = 100'000;
constexpr size_t photon_bytes = 28;

uint64_t key_from(const std::string& text) {
  uint64_t key = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, key, 16);
  if (error != std::errc() || last != end)
    throw RequestError(400, "'known' is no key of photons", "give the key of an answer before");
  return key;
}

Json names_of_lamps(const Scene& scene) {
  Json names = Json::array();
  for (size_t i = 0; i < scene.lights().size(); ++i) names.push_back(scene.light_name(i));
  return names;
}

template <typename T>
char* put(char* at, T value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

char* put(char* at, const DrawnPhoton& photon) {
  for (int axis = 0; axis < 3; ++axis) at = put(at, photon.position[axis]);
  for (size_t lane = 0; lane < 3; ++lane) at = put(at, photon.flux.lanes[lane]);
  at = put(at, uint8_t(photon.map));
  at = put(at, uint8_t(std::min<uint32_t>(photon.level, 255)));
  return put(at, uint16_t(std::min<uint32_t>(photon.light, 65535)));
}

}  // namespace

PhotonQuery PhotonQuery::from(const Query& query) {
  query.allow_only({"max", "known"});
  PhotonQuery photons;
  if (const auto most = query.integer("max", 1, most_photons)) photons.most = size_t(*most);
  if (const std::string known = query.text("known"); !known.empty())
    photons.known = key_from(known);
  return photons;
}

PhotonAnswers::~PhotonAnswers() {
  stop_.request_stop();
  worker_.stop();
}

void PhotonAnswers::answer(const PhotonQuery& query, PhotonScene of,
                           std::shared_ptr<HttpReply> reply) {
  const auto shared = std::make_shared<const PhotonScene>(std::move(of));
  worker_.run([this, query, shared, reply = std::move(reply)] {
    // Clients that have gone meanwhile need none.
    if (!reply->is_open()) return;
    HttpResponse answer;
    try {
      answer = response(query, *shared);
    } catch (...) {
      answer = response_of_current_exception();
    }
    reply->send(std::move(answer));
  });
}

HttpResponse PhotonAnswers::response(const PhotonQuery& query, const PhotonScene& of) {
  const uint64_t key = drawn_photons_key(of.description, *of.scene, seed_);
  if (query.known == key) return {204, "", {}};
  if (key != key_) {
    key_ = 0;
    drawn_ = draw_photons(of.description, *of.scene, seed_, threads_, size_t(most_photons),
                          stop_.get_token());
    if (stop_.stop_requested()) throw RequestError(503, "the view is ending");
    key_ = key;
  }
  return {200,
          "application/octet-stream",
          {},
          std::make_shared<const std::string>(encoded_photons(drawn_, query.most, key, *of.scene))};
}

std::string encoded_photons(const DrawnPhotons& drawn, size_t most, uint64_t key,
                            const Scene& scene) {
  const size_t count = std::min(most, drawn.photons.size());
  std::string text = text_of_json({{"count", count},
                                   {"total", drawn.total},
                                   {"key", fmt::format("{:x}", key)},
                                   {"kinds", {"global", "caustic", "volume"}},
                                   {"lamps", names_of_lamps(scene)}});
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string bytes(4 + text.size() + count * photon_bytes, '\0');
  char* at = put(bytes.data(), uint32_t(text.size()));
  at = std::copy(text.begin(), text.end(), at);
  for (size_t i = 0; i < count; ++i) at = put(at, drawn.photons[i]);
  return bytes;
}

}  // namespace kaustik::view
