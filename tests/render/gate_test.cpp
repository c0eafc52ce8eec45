// Threads that rest.

#include "kaustik/render/gate.h"

#include <gtest/gtest.h>

#include <thread>

namespace kaustik {
namespace {

TEST(Gate, HoldsWhileItIsClosed) {
  Gate gate;
  const std::stop_source stop;
  gate.pass(stop.get_token());
  EXPECT_EQ(gate.closed_s(), 0);
  gate.close();
  gate.close();
  std::atomic<bool> was_opened = false;
  std::thread thread([&] {
    gate.pass(stop.get_token());
    EXPECT_TRUE(was_opened);
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const double before = gate.closed_s();
  EXPECT_GT(before, 0);
  was_opened = true;
  gate.open();
  thread.join();
  const double closed = gate.closed_s();
  EXPECT_GE(closed, before);
  EXPECT_EQ(gate.closed_s(), closed) << "it is open";
}

TEST(Gate, AStopOpensItForWhoWaits) {
  Gate gate;
  std::stop_source stop;
  gate.close();
  std::thread thread([&] { gate.pass(stop.get_token()); });
  stop.request_stop();
  thread.join();
  EXPECT_TRUE(gate.is_closed());
}

}  // namespace
}  // namespace kaustik
