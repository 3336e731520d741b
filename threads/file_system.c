/* file_system.c: see file_system.h.
 * Threads: any. */
#define _GNU_SOURCE
#include "file_system.h"

#include <stddef.h>
#include <stdint.h>
#if defined(__linux__)
#include <sys/vfs.h>
#endif

bool file_system_is_network(int descriptor)
{
#if defined(__linux__)
    static const uint32_t NETWORKS[] = {
        0x6969,     /* NFS */
        0x517b,     /* SMB */
        0xff534d42, /* CIFS */
        0xfe534d42, /* SMB2 */
        0x01021997, /* 9P */
        0x65735546, /* FUSE: sshfs and many others */
        0x00c36400, /* Ceph */
        0x0bd00bd0, /* Lustre */
        0x47504653, /* GPFS */
        0x19830326, /* BeeGFS */
        0x7461636f, /* OCFS2 */
        0x01161970, /* GFS2 */
        0x5346414f, /* AFS */
        0x73757245, /* Coda */
        0x6b414653, /* kAFS */
        0xaad7aaea, /* PanFS */
    };
    struct statfs system;
    if (fstatfs(descriptor, &system) != 0)
        return true;
    for (size_t i = 0; i < sizeof NETWORKS / sizeof *NETWORKS; i++)
        if ((uint32_t)system.f_type == NETWORKS[i])
            return true;
    return false;
#else
    (void)descriptor;
    return true;
#endif
}
