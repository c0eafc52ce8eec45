// Quotas of control groups, read from made-up trees of proc and sys.

#include "kaustik/base/cpu_quota.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "kaustik/base/processors.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

class CpuQuota : public testing::Test {
 protected:
  /// What the process is told of its groups and of what is mounted.
  void groups(const std::string& text) const { write("/proc/self/cgroup", text); }
  void mounts(const std::string& text) const { write("/proc/self/mountinfo", text); }
  void write(const std::string& path, const std::string& text) const {
    const fs::path file = root() + path;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  std::string root() const { return folder_.path("root"); }
  double quota() const { return cgroup_cpu_quota(root()); }

  static constexpr const char* v2_mount =
      "24 1 0:21 / /proc rw shared:1 - proc proc rw\n"
      "31 24 0:27 / /sys/fs/cgroup rw,nosuid shared:9 master:3 - cgroup2 cgroup2 rw,nsdelegate\n";
  static constexpr const char* v1_mount =
      "32 30 0:28 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
      "33 30 0:29 / /sys/fs/cgroup/cpuset rw - cgroup cgroup rw,cpuset\n";

 private:
  test::TemporaryFolder folder_;
};

TEST_F(CpuQuota, NothingToReadIsNoQuota) {
  EXPECT_TRUE(std::isinf(quota()));
  mounts(v2_mount);
  EXPECT_TRUE(std::isinf(quota()));
  groups("0::/job\n");
  EXPECT_TRUE(std::isinf(quota()));
}

TEST_F(CpuQuota, OfVersion2) {
  mounts(v2_mount);
  groups("0::/slurm/job_7\n");
  write("/sys/fs/cgroup/slurm/job_7/cpu.max", "150000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 1.5);
  write("/sys/fs/cgroup/slurm/job_7/cpu.max", "max 100000\n");
  EXPECT_TRUE(std::isinf(quota()));
}

TEST_F(CpuQuota, TheTightestOfAllAboveCounts) {
  mounts(v2_mount);
  groups("0::/pods/pod_1/container\n");
  write("/sys/fs/cgroup/pods/cpu.max", "800000 100000\n");
  write("/sys/fs/cgroup/pods/pod_1/cpu.max", "100000 50000\n");
  write("/sys/fs/cgroup/pods/pod_1/container/cpu.max", "max 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2);
  // A neighbour's quota is none of ours.
  write("/sys/fs/cgroup/pods/pod_2/cpu.max", "10000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2);
  write("/sys/fs/cgroup/pods/cpu.max", "50000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 0.5);
}

TEST_F(CpuQuota, OfVersion1) {
  mounts(v1_mount);
  groups("5:cpuset:/elsewhere\n4:cpu,cpuacct:/batch/job\n0::/\n");
  write("/sys/fs/cgroup/cpu,cpuacct/batch/job/cpu.cfs_quota_us", "-1\n");
  write("/sys/fs/cgroup/cpu,cpuacct/batch/job/cpu.cfs_period_us", "100000\n");
  EXPECT_TRUE(std::isinf(quota()));
  write("/sys/fs/cgroup/cpu,cpuacct/batch/cpu.cfs_quota_us", "300000\n");
  write("/sys/fs/cgroup/cpu,cpuacct/batch/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(quota(), 3);
}

TEST_F(CpuQuota, TheTighterOfBothVersions) {
  mounts(std::string(v1_mount) + "40 30 0:40 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  groups("4:cpu,cpuacct:/a\n0::/b\n");
  write("/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "400000\n");
  write("/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n");
  write("/sys/fs/cgroup/unified/b/cpu.max", "250000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2.5);
}

TEST_F(CpuQuota, InContainersTheMountedGroupIsTheTop) {
  // Without a namespace of groups: the names are those of the host, the mount is the container's.
  mounts("50 30 0:28 /docker/abc /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n");
  groups("4:cpu:/docker/abc\n");
  write("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "200000\n");
  write("/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2);
  groups("4:cpu:/docker/abc/worker\n");
  write("/sys/fs/cgroup/cpu/worker/cpu.cfs_quota_us", "100000\n");
  write("/sys/fs/cgroup/cpu/worker/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(quota(), 1);
  // A group that isn't below what is mounted.
  groups("4:cpu:/../other\n");
  EXPECT_DOUBLE_EQ(quota(), 2);
}

TEST_F(CpuQuota, NamesMayHaveBlanksAndColons) {
  mounts("31 24 0:27 / /sys/fs/c\\040group rw - cgroup2 cgroup2 rw\n");
  groups("0::/a b:c\n");
  write("/sys/fs/c group/a b:c/cpu.max", "100000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 1);
}

TEST_F(CpuQuota, NonsenseIsNoQuota) {
  mounts(std::string("short line\n31 24 - cgroup2\n\n") + v2_mount);
  groups("nonsense\n0::/job\n");
  for (const char* text : {"", "max", "100000", "0 100000", "-5 100000", "100000 0", "x y"}) {
    write("/sys/fs/cgroup/job/cpu.max", text);
    EXPECT_TRUE(std::isinf(quota())) << text;
  }
}

TEST_F(CpuQuota, LimitsTheProcessorsInUse) {
  mounts(v2_mount);
  groups("0::/job\n");
  write("/sys/fs/cgroup/job/cpu.max", "50000 100000\n");
  const Processors here = processors(root());
  EXPECT_DOUBLE_EQ(here.quota, 0.5);
  EXPECT_EQ(here.usable(), 1);
}

}  // namespace
}  // namespace kaustik
