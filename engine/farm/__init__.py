# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame over many machines: ranges of its samples are tasks of a Dask cluster, and their sums one picture.

`python3 build.py farm SCENE.json -o OUT.exr` is the command, addon/docs/farm.md its page. Nothing else imports this
package, and Dask is imported by `cluster` and `on_worker` alone.
"""
