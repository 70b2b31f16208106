// SPDX-License-Identifier: BSD-3-Clause
// Computes counts of species for which a scene gives a packing, or a share of discs or of area.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scene/limits.hpp"
#include "scene/species_rows.hpp"

namespace carrom {

namespace {

/// The keys that can give a row's number of discs, and their indices in the row.
constexpr std::array<std::pair<std::string_view, std::size_t>, 4> sources = {
    {{"count", species_row::count},
     {"packing", species_row::packing},
     {"share", species_row::share},
     {"share_of_area", species_row::share_of_area}}};
constexpr double largest_fault = 1e-9; ///< allowed deviation of the sum of shares from 1

/// Why the number of discs of a row cannot be computed; empty if it can.
std::string problem_of(const Numbers& row) {
    std::string first;
    for (const auto& [name, place] : sources) {
        if (!is_given(row, place)) continue;
        if (!first.empty()) return fmt::format("{} and {} exclude each other", first, name);
        first = name;
        if (name != "count" && !(row[place] > 0 && row[place] <= 1))
            return fmt::format("its {} must be greater than 0 and at most 1, not {}", name,
                               row[place]);
    }
    return first.empty() ? "it needs count, packing, share or share_of_area" : "";
}

/// Splits n into whole numbers that are proportional to the weights, except for rounding. Their sum
/// is n; the sum of the weights must be 1.
std::vector<double> split(double n, const std::vector<double>& weights) {
    std::vector<double> parts, rests;
    for (const double weight : weights) {
        parts.push_back(std::floor(n * weight));
        rests.push_back(n * weight - parts.back());
    }
    std::vector<std::size_t> order(weights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return rests[a] > rests[b]; });
    double left = n - std::accumulate(parts.begin(), parts.end(), 0.0);
    for (const std::size_t k : order) {
        if (left < 1) break;
        parts[k] += 1;
        left -= 1;
    }
    return parts;
}

class SpeciesCounts {
public:
    SpeciesCounts(const SceneDraft& draft, Setting& setting) : draft_(draft), setting_(setting) {
        for (Value& row : std::get<Values>(setting.value.data))
            if (auto* numbers = std::get_if<Numbers>(&row.data)) rows_.push_back(numbers);
    }

    /// Computes the counts of all rows. Returns false if a count cannot be computed.
    bool fill() {
        if (setting_.is_wrong || !are_sources_right()) return false;
        if (std::ranges::all_of(rows_, [](const Numbers* row) { return is_given(*row, 0); }))
            return true;
        if (draft_.scene.box == Box()) return false; // reported already
        for (Numbers* row : rows_)
            if (is_given(*row, species_row::packing)) (*row)[0] = count_in_region(*row);
        return fill_shares() && are_counts_right();
    }

private:
    bool are_sources_right() {
        const std::size_t n_problems = draft_.problems.size();
        draft_.refuse_rows("discs.species", [](const Numbers& row, std::size_t) {
            std::string text = problem_of(row);
            if (text.empty() && !is_given(row, 0))
                text = column_problem(DiscColumn::radius, row[1]);
            const double* const r = &row[species_row::region];
            if (text.empty() && is_given(row, species_row::packing) &&
                is_given(row, species_row::region) && !(r[0] < r[2] && r[1] < r[3]))
                text = "its region must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1";
            return text;
        });
        return draft_.problems.size() == n_problems;
    }
    bool refuse(const std::string& text) {
        draft_.refuse({"discs.species"}, text);
        return false;
    }

    double count_in_region(const Numbers& row) const {
        double area = draft_.scene.area();
        const double* const r = &row[species_row::region];
        if (is_given(row, species_row::region))
            area = (r[2] - r[0]) * (r[3] - r[1]);
        else if (const auto& all = draft_.scene.region)
            area = (all->x_high - all->x_low) * (all->y_high - all->y_low);
        return count_of_packing(row[species_row::packing], area, row[1]);
    }

    bool fill_shares() {
        if (!draft_.scene.has_shares) return true;
        const std::size_t place = is_given(*rows_[0], species_row::share)
                                      ? species_row::share
                                      : species_row::share_of_area;
        if (!std::ranges::all_of(rows_, [&](const Numbers* row) { return is_given(*row, place); }))
            return refuse("rows of 'discs.species' have a share or a share_of_area: the same of "
                          "the two in all rows");
        std::vector<double> weights;
        for (const Numbers* row : rows_) weights.push_back((*row)[place]);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        if (!(std::fabs(sum - 1) <= largest_fault))
            return refuse(
                fmt::format("shares in 'discs.species' sum to {:.10g}, and must sum to 1", sum));
        if (place == species_row::share_of_area)
            for (std::size_t k = 0; k < rows_.size(); ++k)
                weights[k] /= (*rows_[k])[1] * (*rows_[k])[1];
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (double& weight : weights) weight /= total;
        const double n = number_of_all(weights);
        if (n == 0) return false;
        const std::vector<double> parts = split(n, weights);
        for (std::size_t k = 0; k < rows_.size(); ++k) (*rows_[k])[0] = parts[k];
        return true;
    }

    /// The number of all discs, to which shares refer; 0 if it is unknown, which is an error.
    double number_of_all(const std::vector<double>& weights) {
        const bool has_count = draft_.settings.has("discs.count");
        const Setting* packing = draft_.settings.find("discs.packing");
        if (has_count == (packing != nullptr)) {
            refuse(fmt::format("shares in 'discs.species' are of the discs that 'discs.count' or "
                               "'discs.packing' gives: give one of the two{}",
                               has_count ? ", not both" : ""));
            return 0;
        }
        // An invalid count gives 0 here, because the scene then has no number of discs
        if (has_count) return static_cast<double>(draft_.scene.n_discs);
        if (packing->is_wrong) return 0;
        double square = 0; // mean of r^2
        for (std::size_t k = 0; k < rows_.size(); ++k)
            square += weights[k] * (*rows_[k])[1] * (*rows_[k])[1];
        const double n = count_of_packing(std::get<double>(packing->value.data),
                                          draft_.scene.area(), std::sqrt(square));
        if (n >= 1 && n <= static_cast<double>(largest_count)) return n;
        refuse(fmt::format("'discs.packing' gives {} discs of the radii in 'discs.species'; from 1 "
                           "to {} are possible",
                           n, largest_count));
        return 0;
    }

    bool are_counts_right() {
        const std::size_t n_problems = draft_.problems.size();
        draft_.refuse_rows("discs.species", [](const Numbers& row, std::size_t) -> std::string {
            if (row[0] >= 1 && row[0] <= static_cast<double>(largest_count)) return {};
            return fmt::format("its share or packing gives {} discs; from 1 to {} are possible",
                               row[0], largest_count);
        });
        const bool are_right = draft_.problems.size() == n_problems;
        for (Numbers* row : rows_) // if one is wrong, all are removed, so checks report it once
            if (!are_right) (*row)[0] = not_given;
        return are_right;
    }

    const SceneDraft& draft_;
    Setting& setting_;
    std::vector<Numbers*> rows_;
};

} // namespace

double count_of_packing(double packing, double area, double radius) {
    return std::floor(packing * (area / (std::numbers::pi * radius * radius)) + 0.5);
}

void fill_species_counts(const SceneDraft& draft) {
    Setting* setting = draft.settings.find_to_complete("discs.species");
    if (!setting || !std::holds_alternative<Values>(setting->value.data)) return;
    if (draft.settings.has("discs.groups")) return; // groups give the counts
    setting->is_wrong = !SpeciesCounts(draft, *setting).fill();
    if (setting->is_wrong)
        draft.scene.effects.species.clear(); // the known counts are incomplete
    else
        find_key("discs.species")->set(draft.scene, setting->value);
}

} // namespace carrom
