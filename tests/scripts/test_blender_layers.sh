#!/usr/bin/env bash
# Every layer reaches Blender's compositor: it drops channels whose names do not end in one letter behind a point.
# Skipped where Blender is not installed.
set -euo pipefail
# shellcheck source=tests/fixtures/shell_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/../fixtures/shell_test.sh"
need blender
cd "$folder"

"$AFTERGLOW_PROGRAM" -q --photons 2000 --caustic-photons 0 --gather-samples 4 --spp 2 --noise 0 --size 16x16 \
    --aov all,tile_time -o layers.exr:float "$root/tests/scenes/box_with_blocks.pbrt"
cat >sockets.py <<'PYTHON'
import os

import bpy
scene = bpy.context.scene
scene.use_nodes = True
node = scene.node_tree.nodes.new('CompositorNodeImage')
node.image = bpy.data.images.load(os.path.abspath('layers.exr'))
names = [o.name for o in node.outputs if o.enabled]
node.layer = 'id'  # what stands before the last point but one is a layer of its own
names += ['id.' + o.name for o in node.outputs if o.enabled]
print('SOCKETS', ' '.join(names))
PYTHON
HOME=$folder timeout 120 blender -b --factory-startup -P sockets.py >blender.log 2>&1 || {
    tail -20 blender.log
    exit 1
}
sockets=" $(grep -m 1 ^SOCKETS blender.log) "
for layer in Depth albedo N P emission direct indirect caustic specular irradiance variance samples id.object \
    id.material photon_density cache_state photon_distance gather_distance tile_time; do
    [[ $sockets == *" $layer "* ]] || {
        echo "FAILED: the compositor has no '$layer':$sockets"
        grep "multilayer read" blender.log || true
        exit 1
    }
done
! grep "multilayer read" blender.log
