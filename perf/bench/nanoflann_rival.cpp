/* nanoflann_rival.cpp: see nanoflann_rival.h. Its own recommendation for points in space: single index, leaves of
 * ten. */
#include "bench/nanoflann_rival.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <nanoflann.hpp>
#pragma GCC diagnostic pop

namespace
{
struct cloud {
    const float *points;
    size_t count;
    size_t kdtree_get_point_count() const { return count; }
    float kdtree_get_pt(size_t index, size_t axis) const { return points[3 * index + axis]; }
    template <class BBOX>
    bool kdtree_get_bbox(BBOX &) const
    {
        return false;
    }
};
using index_tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3, uint32_t>;
} // namespace

struct nanoflann_tree {
    cloud points;
    index_tree tree;
    nanoflann_tree(const float *p, size_t count)
        : points{p, count}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(10))
    {
        tree.buildIndex();
    }
};

nanoflann_tree *nanoflann_tree_create(const float *points, size_t count)
{
    try {
        return new nanoflann_tree(points, count);
    } catch (...) {
        return nullptr;
    }
}

void nanoflann_tree_destroy(nanoflann_tree *tree) { delete tree; }

size_t nanoflann_tree_nearest(const nanoflann_tree *tree, const float query[3], size_t wanted, uint32_t *out_indices,
                              float *out_distances_squared)
{
    nanoflann::KNNResultSet<float, uint32_t> found(wanted);
    found.init(out_indices, out_distances_squared);
    tree->tree.findNeighbors(found, query, nanoflann::SearchParams());
    return found.size();
}
