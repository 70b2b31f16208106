// SPDX-License-Identifier: BSD-3-Clause
// Rows of scenes that give coefficients of contacts for single species or pairs of species.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// The fields restitution, tangential_restitution and friction, each of which a row may leave out.
std::vector<Field> contact_fields();

/// The number of rows of `discs.species`; nothing if the scene has no rows that can be read.
std::optional<std::size_t> count_species_rows(const SceneDraft& draft);
bool is_species_row(double number, std::size_t n_rows);

/// Why restitution, tangential restitution or friction of `row` (indices `begin` to `begin` + 2) is
/// wrong; empty if all are valid. `why_smooth`: the setting that the last two lack, or empty.
std::string problem_of_contact_numbers(const Numbers& row, std::size_t begin,
                                       std::string_view why_smooth);

} // namespace carrom
