#pragma once
#include <string>

namespace kaustik {

/// How many processors' time the control groups (cgroups) of this process let it have: the tightest
/// quota of its own groups and all above them, of version 1 and 2. Infinity: no quota. May be less
/// than 1. Files that are missing or can't be understood set no quota.
///
/// `root` is the folder in which proc and sys are looked for; another one than "" is for tests.
/// Sources: the kernel's admin-guide/cgroup-v2 (cpu.max), scheduler/sched-bwc (cpu.cfs_quota_us),
/// proc(5) (mountinfo), cgroups(7) (/proc/PID/cgroup).
double cgroup_cpu_quota(const std::string& root = "");

}  // namespace kaustik
