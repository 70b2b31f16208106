// SPDX-License-Identifier: BSD-3-Clause
#include "measure/field_sums.hpp"

#include <cmath>
#include <span>

namespace carrom {

namespace {

/// A typical term of a disc is some 2^50 units, and a sum can hold 2^75 such terms. A typical term
/// of a collision is some 2^47 units, so that the largest of a million terms is below 2^51 units.
constexpr double headroom = 0x1p75, headroom_of_contacts = 0x1p78;
constexpr std::size_t words_per_cell = 1 + 4 * n_field_moments;

} // namespace

FieldSums::FieldSums(std::size_t n_cells, double speed, double length)
    : speed_(speed), length_(length) {
    counts_.assign(n_cells, 0);
    clear();
}

void FieldSums::clear() {
    counts_.assign(counts_.size(), 0);
    sums_.clear();
    gathered_.assign(counts_.size(), {});
    std::vector<ExactSum> of_cell;
    const auto add = [&of_cell](double usual, std::size_t n) {
        of_cell.insert(of_cell.end(), n, ExactSum(usual * headroom));
    };
    add(1, 1);
    add(speed_, 2);
    add(speed_ * speed_, 3);
    add(speed_ * speed_ * speed_, 2);
    add(speed_ * length_ * headroom_of_contacts / headroom, 3);
    add(speed_ * speed_ * length_ * headroom_of_contacts / headroom, 2);
    for (std::size_t k = 0; k < n_disc_moments; ++k) scales_[k] = of_cell[k].scale();
    const double stress = -of_cell[field_stress_xx].scale(), heat = -of_cell[field_heat_x].scale();
    normal_scales_ = Pair{stress, stress};
    shear_scales_ = normal_scales_ / 2;
    flow_scales_ = Pair{heat, heat} / 2;
    usual_square_ = (usual_speeds * speed_) * (usual_speeds * speed_);
    for (std::size_t cell = 0; cell < counts_.size(); ++cell)
        sums_.insert(sums_.end(), of_cell.begin(), of_cell.end());
}

ContactUnits FieldSums::units_of(const ContactTerms& terms) {
    const auto limited = [](double units) {
        if (std::fabs(units) < most_gathered) units = (units + rounder) - rounder;
        return static_cast<std::int64_t>(std::clamp(units, -0x1p62, 0x1p62));
    };
    return {limited(terms.normal[0]), limited(terms.shear[0]), limited(terms.normal[1]),
            limited(terms.flow[0]), limited(terms.flow[1])};
}

ContactUnits FieldSums::units_of(const Gathered& gathered) {
    const auto without_rounders = [&gathered](std::uint64_t word) {
        return static_cast<std::int64_t>(word - gathered.n * bits_of_rounder);
    };
    return {without_rounders(gathered.normal[0]), without_rounders(gathered.shear[0]),
            without_rounders(gathered.normal[1]), without_rounders(gathered.flow[0]),
            without_rounders(gathered.flow[1])};
}

void FieldSums::hand_over(std::size_t cell) {
    add_contact(cell, units_of(gathered_[cell]));
    gathered_[cell] = {};
}

ExactSum FieldSums::sum_at(std::size_t cell, std::size_t moment) const {
    ExactSum sum = sums_[n_field_moments * cell + moment];
    if (moment >= n_disc_moments) sum.add_units(units_of(gathered_[cell])[moment - n_disc_moments]);
    return sum;
}

namespace {

/// Appends the sum as four words with 32 bits each. Words of several ranks can then be added
/// without overflow.
void append_words(const ExactSum& sum, std::vector<std::uint64_t>& words) {
    for (const std::uint64_t word : {sum.low_word(), sum.high_word()}) {
        words.push_back(word & 0xffffffff);
        words.push_back(word >> 32);
    }
}

void add_words_to(ExactSum& sum, const std::uint64_t* words) {
    sum.add_words(words[0], 0);
    sum.add_words(words[1] << 32, words[1] >> 32);
    sum.add_words(0, words[2]);
    sum.add_words(0, words[3] << 32);
}

} // namespace

std::vector<std::uint64_t> FieldSums::joined_words(const Communicator& ranks) const {
    std::vector<std::uint64_t> words;
    words.reserve(words_per_cell * size());
    for (std::size_t cell = 0; cell < size(); ++cell) {
        words.push_back(counts_[cell]);
        for (std::size_t k = 0; k < n_field_moments; ++k) append_words(sum_at(cell, k), words);
    }
    ranks.sum(std::span(words));
    return words;
}

bool FieldSums::add_words(const std::vector<std::uint64_t>& words) {
    if (words.size() != words_per_cell * size()) return false;
    const std::uint64_t* next = words.data();
    for (std::size_t cell = 0; cell < size(); ++cell) {
        counts_[cell] += *next++;
        for (std::size_t k = 0; k < n_field_moments; ++k, next += 4)
            add_words_to(sums_[n_field_moments * cell + k], next);
    }
    return true;
}

void FieldSums::add_discs(const FieldSums& other) {
    for (std::size_t cell = 0; cell < size(); ++cell) {
        counts_[cell] += other.counts_[cell];
        for (std::size_t k = 0; k < n_disc_moments; ++k)
            sums_[n_field_moments * cell + k] += other.sums_[n_field_moments * cell + k];
    }
}

void FieldSums::clear_discs() {
    counts_.assign(counts_.size(), 0);
    for (std::size_t cell = 0; cell < size(); ++cell)
        for (std::size_t k = 0; k < n_disc_moments; ++k) sums_[n_field_moments * cell + k].clear();
}

void FieldSums::join_discs(const Communicator& ranks) {
    if (ranks.size() == 1) return;
    std::vector<std::uint64_t> words;
    words.reserve((1 + 4 * n_disc_moments) * size());
    for (std::size_t cell = 0; cell < size(); ++cell) {
        words.push_back(counts_[cell]);
        for (std::size_t k = 0; k < n_disc_moments; ++k)
            append_words(sums_[n_field_moments * cell + k], words);
    }
    ranks.sum(std::span(words));
    clear_discs();
    const std::uint64_t* next = words.data();
    for (std::size_t cell = 0; cell < size(); ++cell) {
        counts_[cell] = *next++;
        for (std::size_t k = 0; k < n_disc_moments; ++k, next += 4)
            add_words_to(sums_[n_field_moments * cell + k], next);
    }
}

void FieldSums::add(const FieldSums& other, std::size_t first) {
    for (std::size_t cell = 0; cell < size(); ++cell) {
        counts_[cell] += other.counts_[first + cell];
        for (std::size_t k = 0; k < n_field_moments; ++k)
            sums_[n_field_moments * cell + k] += other.sum_at(first + cell, k);
    }
}

FieldSums FieldSums::over_species(std::size_t n_species) const {
    FieldSums all(size() / n_species, speed_, length_);
    for (std::size_t species = 0; species < n_species; ++species)
        all.add(*this, species * all.size());
    return all;
}

} // namespace carrom
