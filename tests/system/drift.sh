#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Diffusion in a periodic box is measured relative to the centre of mass. It does not depend on the
# initial drift or on the length of windows. With the drift D would grow with the window: a velocity
# V adds V^2 t.
source "$(dirname "$0")/common.sh"
{ periodic_box 100; cat; } >gas.toml <<'END'
[discs]
count = 1000
packing = 0.4
[time]
steps = 2500
[output.measurements]
quantities = ["diffusion"]
every_steps = 5
from_step = 100
END

drift='[{region = [0, 0, 100, 100], velocity = [0.3, -0.2]}]'
for window in 20 500; do
    for seed in 1 2 3; do
        for streams in '[]' "$drift"; do
            run 1 run gas.toml -o run --overwrite --quiet --set discs.seed=$seed \
                --set output.measurements.correlation_steps=$window --set "discs.streams=$streams"
            expect_code 0 "seed $seed, window $window"
            grep -v '^#' run/measurements/diffusion.csv | sed -n 2p
        done
    done >values
    # The six values of D agree within four of their errors. With the drift they would be larger
    # by 1 for the short window and by 24 for the long one.
    awk -F, '{ d[NR] = $1; e[NR] = $2 }
        END { for (i in d) for (k in d) if ((d[i] - d[k]) ^ 2 > 16 * (e[i] ^ 2 + e[k] ^ 2)) exit 1
              exit NR != 6 }' values || complain "window $window: $(cat values)"
done
finish
