#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "kaustik/photon/drawn_photons.h"
#include "kaustik/scene/description.h"
#include "kaustik/view/http_message.h"
#include "kaustik/view/query.h"
#include "kaustik/view/worker.h"

namespace kaustik {
class Scene;
}

namespace kaustik::view {

/// Which photons are asked for.
struct PhotonQuery {
  size_t most = 20'000;
  std::optional<uint64_t> known;  ///< key of those that the client has

  /// Throws RequestError.
  static PhotonQuery from(const Query& query);
};

/// A scene whose photons are asked for.
struct PhotonScene {
  Description description;  ///< whose integrator says how many photons there are
  std::shared_ptr<const Scene> scene;
};

/// Answers with photons of a scene's photon maps. They are traced in a thread of their own, which
/// may take seconds, once for all cameras and all who ask.
class PhotonAnswers {
 public:
  PhotonAnswers(uint64_t seed, int threads) : seed_(seed), threads_(threads) {}
  /// Ends what is being traced.
  ~PhotonAnswers();
  PhotonAnswers(const PhotonAnswers&) = delete;
  PhotonAnswers& operator=(const PhotonAnswers&) = delete;

  /// From the server's thread.
  void answer(const PhotonQuery& query, PhotonScene of, std::shared_ptr<HttpReply> reply);

 private:
  /// In the worker's thread.
  HttpResponse response(const PhotonQuery& query, const PhotonScene& of);

  uint64_t seed_;
  int threads_;
  std::stop_source stop_;
  // Of the worker:
  uint64_t key_ = 0;  ///< of `drawn_`; 0: there are none
  DrawnPhotons drawn_;
  Worker worker_;
};

/// Photons as they are sent: the length of a text (32 bits), which is a multiple of four, the text,
/// which is JSON, then 28 bytes for each photon: position (m) and flux (W; red, green, blue) as six
/// floats, map and level (255: that many or more) as one byte each, lamp in 16 bits. Little endian.
/// The first `most` of `drawn`.
std::string encoded_photons(const DrawnPhotons& drawn, size_t most, uint64_t key,
                            const Scene& scene);

}  // namespace kaustik::view
