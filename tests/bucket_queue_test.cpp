#include "util/bucket_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "made_points.h"

namespace meshgrain {
namespace {

constexpr float width = 0.5f;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Pops all, and checks that what comes is never more than a bucket cheaper than what came before.
std::vector<std::uint32_t> pop_all(BucketQueue& queue) {
  std::vector<std::uint32_t> items;
  float most = 0;
  while (queue.find()) {
    const auto [cost, item] = queue.pop();
    EXPECT_FALSE(cost < most - width - 1e-3f) << cost << " after " << most;
    most = std::max(most, cost);
    items.push_back(item);
  }
  return items;
}

/// Some reach far beyond the buckets.
TEST(BucketQueue, CostsComeInOrder) {
  BucketQueue queue(width);
  constexpr std::uint32_t count = 3000;
  for (std::uint32_t i = 0; i < count; ++i) {
    queue.push((i % 3 == 0 ? 2000.0f : 100.0f) * (1 + made::noise(i)), i);
  }
  std::vector<std::uint32_t> items = pop_all(queue);
  std::ranges::sort(items);
  ASSERT_EQ(items.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(items[i], i);
}

TEST(BucketQueue, WhatIsCheaperThanAllElseComesNext) {
  BucketQueue queue(width);
  for (const float cost : {40.0f, 20.0f, 30.0f, 1000.0f}) {
    queue.push(cost, static_cast<std::uint32_t>(cost));
  }
  ASSERT_TRUE(queue.find());
  EXPECT_EQ(queue.pop().item, 20u);
  queue.push(10, 10);
  queue.push(25, 25);
  EXPECT_EQ(pop_all(queue), (std::vector<std::uint32_t>{10, 25, 30, 40, 1000}));
}

/// Also than where the buckets begin, after they have moved on.
TEST(BucketQueue, MayFallBehindItsBuckets) {
  BucketQueue queue(width);
  queue.push(5000, 0);
  queue.push(5002, 1);
  ASSERT_TRUE(queue.find());
  EXPECT_EQ(queue.pop().item, 0u);
  queue.push(10, 2);
  ASSERT_TRUE(queue.find());
  EXPECT_EQ(queue.pop().item, 2u);
  EXPECT_EQ(pop_all(queue), std::vector<std::uint32_t>{1});
}

TEST(BucketQueue, InfinityComesLast) {
  BucketQueue queue(width);
  queue.push(infinity, 0);
  queue.push(1e30f, 1);
  queue.push(infinity, 2);
  queue.push(3, 3);
  const std::vector<std::uint32_t> items = pop_all(queue);
  ASSERT_EQ(items.size(), 4u);
  EXPECT_EQ(items[0], 3u);
  EXPECT_EQ(items[1], 1u);
}

TEST(BucketQueue, StartsAnewWhenCleared) {
  BucketQueue queue(width);
  for (const float cost : {5000.0f, 5001.0f, 9000.0f}) queue.push(cost, 0);
  ASSERT_TRUE(queue.find());
  queue.clear();
  EXPECT_FALSE(queue.find());
  queue.push(2, 2);
  queue.push(1, 1);
  EXPECT_EQ(pop_all(queue), (std::vector<std::uint32_t>{1, 2}));
}

TEST(BucketQueue, BucketsAreTakenWhole) {
  BucketQueue queue(width);
  for (std::uint32_t i = 0; i < 6; ++i) queue.push(0.1f + 0.05f * static_cast<float>(i), i);
  queue.push(20, 6);
  std::vector<BucketQueue::Entry> bucket;
  ASSERT_TRUE(queue.take_bucket(bucket));
  EXPECT_EQ(bucket.size(), 6u);
  queue.push(0.2f, 7);  // comes back to the bucket
  ASSERT_TRUE(queue.take_bucket(bucket));
  ASSERT_EQ(bucket.size(), 1u);
  EXPECT_EQ(bucket[0].item, 7u);
  ASSERT_TRUE(queue.take_bucket(bucket));
  ASSERT_EQ(bucket.size(), 1u);
  EXPECT_EQ(bucket[0].item, 6u);
  EXPECT_FALSE(queue.take_bucket(bucket));
  EXPECT_TRUE(bucket.empty());
}

}  // namespace
}  // namespace meshgrain
