// SPDX-License-Identifier: BSD-3-Clause
// "density": discs' centres per area in strips across the box, along both axes.
#include <algorithm>

#include <fmt/format.h>

#include "measure/pair_reach.hpp"
#include "measure/table_parts.hpp"

namespace carrom {

namespace {

class Density : public Measurement {
public:
    explicit Density(MeasuredRun& run) : Measurement(run), x_(n_bins_of(run), 0), y_(x_) {}

    void sample(const SampledState& state) override {
        const Extent& box = state.box;
        const std::size_t n = n_bins_of(run_);
        const double time = run_.system.clock(), last = static_cast<double>(n - 1);
        const double per_x = static_cast<double>(n) / (box.x_high - box.x_low),
                     per_y = static_cast<double>(n) / (box.y_high - box.y_low);
        std::vector<std::uint64_t> x(n, 0), y(n, 0);
        for (const DiscState& disc : state.inside) {
            // A centre on the upper edge of the box counts in the last bin.
            count(x, std::clamp((disc.x_at(time) - box.x_low) * per_x, 0.0, last));
            count(y, std::clamp((disc.y_at(time) - box.y_low) * per_y, 0.0, last));
        }
        add_over(run_.ranks, std::move(x), x_);
        add_over(run_.ranks, std::move(y), y_);
    }

    void keep(KeptNumbers& kept) override {
        kept.same(x_.size());
        kept(x_), kept(y_);
    }

    std::vector<MeasuredTable> tables() const override {
        const SceneParameters& scene = run_.scene;
        return {along(x_, "x", scene.box.x, scene.origin.x),
                along(y_, "y", scene.box.y, scene.origin.y)};
    }

private:
    /// If walls move, positions are fractions of the box's width or height at each sample.
    MeasuredTable along(const std::vector<std::uint64_t>& counts, const char* axis, double length,
                        double origin) const {
        bool is_moving = false;
        for (const Boundary& side : run_.scene.effects.boundaries)
            is_moving = is_moving || side.speed != 0 || side.amplitude != 0;
        const std::size_t n = counts.size();
        const double size = is_moving ? 1 : length, begin = is_moving ? 0 : origin,
                     area = run_.counts.area / static_cast<double>(n);
        MeasuredTable table{
            fmt::format("density_{}", axis),
            {fmt::format("density: discs' centres per area, in strips from `from` to `to` along {}",
                         axis),
             is_moving ? "walls move: places are shares of the box's side at each sample"
                       : "lengths in the scene's unit"},
            {"from", "to", "count", "density"},
            {}};
        for (std::size_t k = 0; k < n; ++k)
            table.rows.push_back({edge(0, size, k, n) - begin, edge(0, size, k + 1, n) - begin,
                                  static_cast<double>(counts[k]),
                                  static_cast<double>(counts[k]) / area});
        return table;
    }

    std::vector<std::uint64_t> x_, y_;
};

} // namespace

MeasuredQuantity density_quantity() {
    return {{.name = "density",
             .help = "Discs per area in strips along x, and along y.",
             .needs_lasting_sides = true,
             .keys = {bins_key()}},
            make_measurement<Density>,
            {"density_x", "density_y"}};
}

} // namespace carrom
