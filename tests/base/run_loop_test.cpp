#include "services/base/run_loop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <future>
#include <thread>
#include <vector>

#include "services/base/latest_worker.h"

namespace beckon {
namespace {

TEST(RunLoop, TimersFireInTheirOrder) {
  RunLoop loop;
  std::vector<int> order;
  loop.After(2000, [&] { order.push_back(2); });
  loop.After(1000, [&] { order.push_back(1); });
  loop.After(3000, [&] { loop.Stop(); });
  loop.Run();
  EXPECT_EQ(order, (std::vector<int>{1, 2}));
}

TEST(RunLoop, ARepeatedTimerStopsWhenCancelledByItself) {
  RunLoop loop;
  int calls = 0;
  RunLoop::TimerId timer = 0;
  timer = loop.Every(500, [&] {
    if (++calls == 3) {
      loop.Cancel(timer);
      loop.After(3000, [&] { loop.Stop(); });
    }
  });
  loop.Run();
  EXPECT_EQ(calls, 3);
}

TEST(RunLoop, ReadableDescriptorsAndPostedWorkRunInTheLoopsThread) {
  RunLoop loop;
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const auto loop_thread = std::this_thread::get_id();
  char received = 0;
  loop.AddFd(ends[0], [&] {
    EXPECT_EQ(read(ends[0], &received, 1), 1);
    loop.RemoveFd(ends[0]);
    loop.Stop();
  });
  std::thread other([&] {
    loop.Post([&] {
      EXPECT_EQ(std::this_thread::get_id(), loop_thread);
      EXPECT_EQ(write(ends[1], "x", 1), 1);
    });
  });
  loop.Run();
  other.join();
  EXPECT_EQ(received, 'x');
  close(ends[0]);
  close(ends[1]);
}

TEST(LatestWorker, TakesTheNewestAndCountsTheRest) {
  std::promise<void> started, release, done;
  std::vector<int> seen;
  LatestWorker<int> worker([&](int input) {
    seen.push_back(input);
    if (input == 1) {
      started.set_value();
      release.get_future().wait();
    } else {
      done.set_value();
    }
  });
  worker.Offer(1);
  started.get_future().wait();
  worker.Offer(2);
  worker.Offer(3);
  worker.Offer(4);
  release.set_value();
  done.get_future().wait();
  EXPECT_EQ(seen, (std::vector<int>{1, 4}));
  EXPECT_EQ(worker.dropped(), 2);
}

}  // namespace
}  // namespace beckon
