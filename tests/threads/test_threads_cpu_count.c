/* test_threads_cpu_count.c: how many threads we are entitled to, by affinity and by cgroup quota.
 * The cgroup file systems are imitated below a temporary directory.
 * Threads: one. */
#define _GNU_SOURCE
#include "cpu_count.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <errno.h>
#include <ftw.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static char root[64];

static int make_root(void **state)
{
    (void)state;
    snprintf(root, sizeof root, "/tmp/afterglow-cgroup-XXXXXX");
    return mkdtemp(root) ? 0 : -1;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk)
{
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

static int remove_root(void **state)
{
    (void)state;
    return nftw(root, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

/* Writes root/path, and makes the directories above it. */
static void put(const char *path, const char *text)
{
    char full[512];
    assert_true(snprintf(full, sizeof full, "%s%s", root, path) < (int)sizeof full);
    for (char *slash = strchr(full + strlen(root) + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        assert_true(mkdir(full, 0700) == 0 || errno == EEXIST);
        *slash = '/';
    }
    FILE *file = fopen(full, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void assert_quota(const char *proc_self_cgroup, const char *mountinfo, double expected)
{
    double quota = cpu_quota_below(root, proc_self_cgroup, mountinfo);
    if (quota != expected)
        fail_msg("quota %g, expected %g, for\n%s", quota, expected, proc_self_cgroup);
}

#define V2_MOUNT "30 23 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n"
#define OTHER_MOUNTS                                                                                                   \
    "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw\n"                                                          \
    "23 22 0:5 / /proc rw,relatime - proc proc rw\n"
#define V1_MOUNTS                                                                                                      \
    "31 23 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"                                                       \
    "33 31 0:30 / /sys/fs/cgroup/cpuset rw shared:7 master:2 - cgroup cgroup rw,cpuset\n"                              \
    "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw shared:6 master:1 - cgroup cgroup rw,cpu,cpuacct\n"

static void test_nothing_to_read(void **state)
{
    (void)state;
    assert_quota("", "", 0.0);
    assert_quota("0::/\n", "", 0.0);
    assert_quota("", OTHER_MOUNTS V2_MOUNT, 0.0);
    assert_quota("0::/\n", OTHER_MOUNTS V2_MOUNT, 0.0); /* the root group has no cpu.max */
    assert_quota("2:cpu,cpuacct:/a\n", V1_MOUNTS, 0.0);
    assert_quota("nonsense\n:::\n0::\n\n0:", "nonsense\n- - -\n1 2 3\n \n30 23 0:26 / /sys - cgroup2", 0.0);
}

static void test_v2(void **state)
{
    (void)state;
    put("/sys/fs/cgroup/job/cpu.max", "150000 100000\n");
    assert_quota("0::/job\n", OTHER_MOUNTS V2_MOUNT, 1.5);
    assert_quota("0::/job", V2_MOUNT, 1.5);
    assert_quota("0::/job/child/that/is/gone (deleted)\n", V2_MOUNT, 1.5);
    assert_quota("0::/jobless\n", V2_MOUNT, 0.0);
    put("/sys/fs/cgroup/job/cpu.max", "max 100000\n");
    assert_quota("0::/job\n", V2_MOUNT, 0.0);
    put("/sys/fs/cgroup/job/cpu.max", "25000 50000\n");
    assert_quota("0::/job\n", V2_MOUNT, 0.5);
    put("/sys/fs/cgroup/job/cpu.max", "25000 0\n");
    assert_quota("0::/job\n", V2_MOUNT, 0.0);
    put("/sys/fs/cgroup/job/cpu.max", "");
    assert_quota("0::/job\n", V2_MOUNT, 0.0);
}

static void test_v2_nested_takes_the_tightest(void **state)
{
    (void)state;
    put("/sys/fs/cgroup/a/cpu.max", "300000 100000\n");
    put("/sys/fs/cgroup/a/b/cpu.max", "max 100000\n");
    put("/sys/fs/cgroup/a/b/c/cpu.max", "800000 100000\n");
    assert_quota("0::/a/b/c\n", V2_MOUNT, 3.0);
    put("/sys/fs/cgroup/a/b/c/cpu.max", "200000 100000\n");
    assert_quota("0::/a/b/c\n", V2_MOUNT, 2.0);
    put("/sys/fs/cgroup/a/b/cpu.max", "100000 100000\n");
    assert_quota("0::/a/b/c\n", V2_MOUNT, 1.0);
    assert_quota("0::/a\n", V2_MOUNT, 3.0);
}

static void test_v1(void **state)
{
    (void)state;
    const char *groups = "5:cpuset:/other\n2:cpu,cpuacct:/job/step\n1:name=systemd:/init\n";
    put("/sys/fs/cgroup/cpu,cpuacct/job/step/cpu.cfs_quota_us", "-1\n");
    put("/sys/fs/cgroup/cpu,cpuacct/job/step/cpu.cfs_period_us", "100000\n");
    assert_quota(groups, V1_MOUNTS, 0.0);
    put("/sys/fs/cgroup/cpu,cpuacct/job/step/cpu.cfs_quota_us", "350000\n");
    assert_quota(groups, V1_MOUNTS, 3.5);
    put("/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "200000\n");
    assert_quota(groups, V1_MOUNTS, 3.5); /* a quota without a period is none */
    put("/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
    assert_quota(groups, V1_MOUNTS, 2.0);
    /* neither the same group of another controller, nor another controller's group at the same path */
    put("/sys/fs/cgroup/cpuset/job/cpu.cfs_quota_us", "10000\n");
    put("/sys/fs/cgroup/cpuset/job/cpu.cfs_period_us", "100000\n");
    put("/sys/fs/cgroup/cpu,cpuacct/other/cpu.cfs_quota_us", "10000\n");
    put("/sys/fs/cgroup/cpu,cpuacct/other/cpu.cfs_period_us", "100000\n");
    assert_quota(groups, V1_MOUNTS, 2.0);
    assert_quota("5:cpuset:/other\n3:cpuacct:/other\n", V1_MOUNTS, 0.0);
    assert_quota("2:cpu,cpuacct:/other\n", V1_MOUNTS, 0.1);
}

/* systemd's hybrid: v1 has the cpu controller, v2 is mounted beside it for bookkeeping. */
static void test_hybrid(void **state)
{
    (void)state;
    const char *mounts = V1_MOUNTS "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n";
    put("/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "200000\n");
    put("/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
    put("/sys/fs/cgroup/unified/job/cgroup.procs", "1\n");
    assert_quota("2:cpu,cpuacct:/job\n0::/job\n", mounts, 2.0);
    put("/sys/fs/cgroup/unified/job/cpu.max", "100000 100000\n");
    assert_quota("2:cpu,cpuacct:/job\n0::/job\n", mounts, 1.0);
}

/* Inside a container the group's path may be the host's, and the mount may show only the container's own group. */
static void test_container(void **state)
{
    (void)state;
    const char *own = "30 23 0:26 /docker/4f5e /sys/fs/cgroup ro - cgroup2 cgroup rw\n";
    put("/sys/fs/cgroup/cpu.max", "400000 100000\n");
    put("/sys/fs/cgroup/inner/cpu.max", "100000 100000\n");
    assert_quota("0::/docker/4f5e\n", own, 4.0);                /* the mount's root is the group */
    assert_quota("0::/docker/4f5e/inner\n", own, 1.0);          /* a group below it */
    assert_quota("0::/docker/4f5e/inner/deeper\n", own, 1.0);   /* below that, with no quota of its own */
    assert_quota("0::/docker/4f5effff/inner\n", own, 4.0);      /* another group whose name begins like it: not shown */
    assert_quota("0::/\n", own, 4.0);                           /* a cgroup namespace of our own */
    put("/sys/fs/cpu.max", "100000 100000\n");                  /* not a cgroup's: above the mount */
    assert_quota("0::/../../elsewhere/inner\n", V2_MOUNT, 4.0); /* moved out of our namespace */
    assert_quota("0::/docker/4f5e\n", V2_MOUNT, 4.0);           /* the host's path, which is not there */

    const char *own_v1 = "32 31 0:29 /docker/4f5e /sys/fs/cgroup/cpu ro - cgroup cgroup rw,cpu\n";
    put("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "250000\n");
    put("/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
    assert_quota("3:cpu:/docker/4f5e\n", own_v1, 2.5);
    assert_quota("3:cpu:/kubepods/pod7\n", own_v1, 2.5);

    /* a mount that shows the group is believed, not one that does not, wherever it stands */
    put("/sys/fs/cgroup/wide/cpu.max", "900000 100000\n");
    const char *both = "30 23 0:26 /docker/4f5e /sys/fs/cgroup ro - cgroup2 cgroup rw\n"
                       "31 23 0:26 /docker /sys/fs/cgroup/wide ro - cgroup2 cgroup rw\n"
                       "32 23 0:26 /docker/88 /sys/fs/cgroup/inner ro - cgroup2 cgroup rw\n";
    assert_quota("0::/docker/77\n", both, 9.0);
}

static void test_paths_with_spaces(void **state)
{
    (void)state;
    put("/mnt/c groups/a job/cpu.max", "100000 100000\n");
    assert_quota("0::/a job\n", "30 23 0:26 / /mnt/c\\040groups rw - cgroup2 cgroup2 rw\n", 1.0);
    put("/mnt/own/cpu.max", "200000 100000\n");
    put("/mnt/own/step/cpu.max", "100000 100000\n");
    assert_quota("0::/a job/step\n", "30 23 0:26 /a\\040job /mnt/own rw - cgroup2 cgroup2 rw\n", 1.0);
}

static void test_affinity(void **state)
{
    (void)state;
    cpu_set_t callers, one;
    assert_int_equal(sched_getaffinity(0, sizeof callers, &callers), 0);
    unsigned available = cpu_count_available();
    assert_in_range(available, 1, (unsigned)CPU_COUNT(&callers));
    size_t first = 0;
    while (!CPU_ISSET(first, &callers))
        first++;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    assert_int_equal(cpu_count_available(), 1);
    assert_int_equal(sched_setaffinity(0, sizeof callers, &callers), 0);
    assert_int_equal(cpu_count_available(), available);
}

int main(void)
{
#define WITH_ROOT(test) cmocka_unit_test_setup_teardown(test, make_root, remove_root)
    const struct CMUnitTest tests[] = {
        WITH_ROOT(test_nothing_to_read),
        WITH_ROOT(test_v2),
        WITH_ROOT(test_v2_nested_takes_the_tightest),
        WITH_ROOT(test_v1),
        WITH_ROOT(test_hybrid),
        WITH_ROOT(test_container),
        WITH_ROOT(test_paths_with_spaces),
        cmocka_unit_test(test_affinity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
