# SPDX-License-Identifier: BSD-3-Clause
# failed_check.sh MISSED_CONTACT RANKS: a run that misses a contact ends with code 70 on every rank,
# names step, disc and rank, and leaves a scene in which the contact is not missed. In the
# event-driven method discs are rough and of two species.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"
missed_contact=$1
n_ranks=$2
program=$CARROM_PROGRAM

for method in time-stepped event-driven; do
    CARROM_PROGRAM=$missed_contact
    run "$n_ranks" "$method"
    expect_code 70 "a missed contact under $method"
    expect_told 'check failed at step 2: disc 5 on rank' "the failure under $method"
    expect_told 'overlaps disc 9 by 2' "the failure under $method"
    expect_told '12 discs around it, from the step before, are in check_step_2_disc_5.toml' \
        "the failure under $method"
    # An HDF5 file of another owner with this name is not replaced, and the exit code stays the
    # same.
    mv check_step_2_disc_5.discs kept.discs
    printf '\211HDF\r\n\032\n' >check_step_2_disc_5.discs
    run "$n_ranks" "$method"
    expect_code 70 "a missed contact beside a file under $method"
    expect_told 'could not be written: the list of its discs check_step_2_disc_5.discs is an HDF5' \
        "a file in the way under $method"
    [ "$(wc -c <check_step_2_disc_5.discs)" = 8 ] || complain "a file is replaced under $method"
    mv kept.discs check_step_2_disc_5.discs
    CARROM_PROGRAM=$program
    run "$n_ranks" run check_step_2_disc_5.toml --check --report report.json
    expect_code 0 "the neighbourhood again under $method"
    [ "$(json_value report.json pair_collisions)" = 1 ] ||
        complain "the contact is missed again under $method"
    [ $method = time-stepped ] || grep -qx '4 31 15 4 0 0.625' check_step_2_disc_5.discs ||
        complain 'no spin of disc 5'
    # Discs 5 and 9 are of rows 1 and 2 there, and of rows 5 and 8 here.
    for line in '{species = [5, 8], restitution = 0.75, tangential_restitution = 0.125, fric' \
        '{species = 8, restitution = 0.25, tangential_restitution = 0.75, friction = 0.125},'; do
        [ $method = time-stepped ] || grep -qF "$line" check_step_2_disc_5.toml ||
            complain "no '$line' in the scene of the neighbourhood"
    done
    for line in 'seed = 77' 'contact_time = 0.002' 'friction = 0.25'; do
        [ $method = time-stepped ] || grep -qx "$line" check_step_2_disc_5.toml ||
            complain "no '$line' in the scene of the neighbourhood"
    done
    [ "$(json_value report.json method)" = $method ] ||
        complain "the neighbourhood is run by another method than $method"
done
finish
