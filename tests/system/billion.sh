#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A thousand million collisions in the event-driven method keep the energy to 1e-12 and let no discs
# overlap. Half an hour.
source "$(dirname "$0")/common.sh"

gas_scene 323.6 10000 0.3 1 236000 >scene.toml
timeout 6000 "$CARROM_PROGRAM" run scene.toml --set time.method=event-driven \
    --quiet --report report.json || complain "exit code $?"
pairs=$(json_value report.json pair_collisions)
[ "${pairs:-0}" -ge 1000000000 ] || complain "only ${pairs:-no} collisions of pairs"
[ "$(json_value report.json overlapping_pairs)" = 0 ] || complain 'discs overlap'
drift=$(json_value report.json energy_drift)
awk -v drift="${drift:-1}" 'BEGIN { exit !(drift <= 1e-12 && drift >= -1e-12) }' ||
    complain "the energy has changed by $drift of itself"
printf '%s collisions, energy changed by %s\n' "$pairs" "$drift"
finish
