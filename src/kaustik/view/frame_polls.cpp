#include "kaustik/view/frame_polls.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "kaustik/live/watched.h"
#include "kaustik/scene/scene.h"
#include "kaustik/view/projection.h"
#include "kaustik/view/request_error.h"
#include "kaustik/view/worker.h"

namespace kaustik::view {
namespace {

/// Less than what proxies commonly allow a request.
constexpr std::chrono::seconds longest_poll(25);
constexpr int64_t largest_number = int64_t(1) << 53;  ///< that JavaScript holds exactly

const char* name_of(Snapshot::Kind kind) {
  switch (kind) {
    case Snapshot::Kind::preview:
      return "preview";
    case Snapshot::Kind::samples:
      return "samples";
    case Snapshot::Kind::passes:
      break;
  }
  return "passes";
}

/// Twelve numbers, row by row.
std::string text_of(const Projection& projection) {
  return fmt::format("{:.9g}", fmt::join(projection, " "));
}

}  // namespace

FrameQuery FrameQuery::from(const Query& query) {
  query.allow_only({"after", "layer", "format", "width"});
  FrameQuery frame;
  frame.after = uint64_t(query.integer("after", 0, largest_number).value_or(0));
  frame.layer = query.text("layer");
  const std::string format = query.text("format");
  if (format == "f32")
    frame.format = FrameFormat::f32;
  else if (!format.empty() && format != "rgb9e5")
    throw RequestError(400, "there is no such format of frames",
                       "give format=rgb9e5 or format=f32");
  if (const auto width = query.integer("width", 1, 1 << 20)) frame.width = int(*width);
  return frame;
}

std::shared_ptr<const LayerPictures::Layers> LayerPictures::of(const Watched& shown,
                                                               uint64_t revision) {
  auto next = std::make_shared<Layers>();
  bool is_known = false, has_layers = false;
  const bool has_film = shown.look_at_film([&](const Film& film) {
    has_layers = film.layers().in_images;
    is_known = has_layers && last_ && last_->revision == revision &&
               last_->passes == film.pass_count() &&
               last_->regional_passes == film.regional_pass_count();
    if (is_known || !has_layers) return;
    next->revision = revision;
    next->passes = film.pass_count();
    next->regional_passes = film.regional_pass_count();
    next->image = film.image();
  });
  if (!has_film || is_known) return is_known ? last_ : nullptr;
  // Another scene may have come meanwhile, or views that move, whose films have no layers.
  if (shown.status().revision != revision) return nullptr;
  if (!has_layers)
    throw RequestError(404, "the scene's film keeps no layers", "ask for the picture alone");
  last_ = std::move(next);
  return last_;
}

HttpResponse frame_response(const FrameQuery& query, const Snapshot& snapshot,
                            const LayerPictures::Layers* layers) {
  const Image& image = layers ? layers->image : snapshot.picture;
  if (!colour_channels(image.channel_names(), query.layer))
    throw RequestError(404, "the picture has no such layer", "GET state lists the layers");
  const int reduction = query.width ? reduction_for(image.width(), *query.width) : 1;
  EncodedFrame frame = encoded_frame(image, query.layer, query.format, reduction);
  HttpResponse response;
  response.content_type = "application/octet-stream";
  response.headers = {{"X-Number", fmt::format("{}", snapshot.number)},
                      {"X-Revision", fmt::format("{}", snapshot.revision)},
                      {"X-Kind", name_of(snapshot.kind)},
                      {"X-Passes", fmt::format("{}", layers ? layers->passes : snapshot.passes)},
                      {"X-Width", fmt::format("{}", frame.width)},
                      {"X-Height", fmt::format("{}", frame.height)},
                      {"X-Scale", fmt::format("{}", frame.scale)},
                      {"X-Moving", snapshot.is_moving ? "1" : "0"}};
  const Vec2i size(image.width(), image.height());
  if (snapshot.scene)
    if (const auto projection = projection_of(snapshot.scene->camera(), size))
      response.headers.emplace_back("X-Projection", text_of(*projection));
  response.body = std::make_shared<const std::string>(std::move(frame.bytes));
  return response;
}

FramePolls::FramePolls(const Watched& shown, Worker& worker) : shown_(shown), worker_(worker) {}

void FramePolls::add(FrameQuery query, std::shared_ptr<HttpReply> reply) {
  polls_.push_back({std::move(query), std::move(reply), Clock::now() + longest_poll});
  serve();
}

bool FramePolls::is_due(const Poll& poll, const Snapshot* snapshot) const {
  // A number that is larger than the last comes from before the server was started again.
  if (!snapshot || snapshot->number == poll.query.after) return false;
  return poll.query.layer.empty() ||
         (snapshot->kind == Snapshot::Kind::passes && !snapshot->is_moving);
}

void FramePolls::serve() {
  std::erase_if(polls_, [](const Poll& poll) { return !poll.reply->is_open(); });
  if (polls_.empty()) return;
  const auto snapshot = shown_.snapshot();
  const auto now = Clock::now();
  std::vector<Poll> waiting, due;
  for (Poll& poll : polls_) {
    if (is_due(poll, snapshot.get()))
      due.push_back(std::move(poll));
    else if (now >= poll.deadline)
      poll.reply->send({204, ""});
    else
      waiting.push_back(std::move(poll));
  }
  polls_ = std::move(waiting);
  while (!due.empty()) {
    // Those that ask for the same share one frame.
    std::vector<Poll> alike;
    FrameQuery query = due.front().query;
    for (auto poll = due.begin(); poll != due.end();) {
      query.after = poll->query.after;
      if (!(poll->query == query)) {
        ++poll;
        continue;
      }
      alike.push_back(std::move(*poll));
      poll = due.erase(poll);
    }
    answer(std::move(alike), snapshot);
  }
}

void FramePolls::answer(std::vector<Poll> polls, std::shared_ptr<const Snapshot> snapshot) {
  const auto shared = std::make_shared<std::vector<Poll>>(std::move(polls));
  worker_.run([shared, snapshot = std::move(snapshot), &shown = shown_, layers = layers_] {
    HttpResponse response;
    try {
      const FrameQuery& query = shared->front().query;
      const auto of_film = query.layer.empty() ? nullptr : layers->of(shown, snapshot->revision);
      // Nothing has the layer now: the client asks again.
      if (!query.layer.empty() && !of_film)
        response.status = 204;
      else
        response = frame_response(query, *snapshot, of_film.get());
    } catch (...) {
      response = response_of_current_exception();
    }
    for (const Poll& poll : *shared) poll.reply->send(response);
  });
}

}  // namespace kaustik::view
