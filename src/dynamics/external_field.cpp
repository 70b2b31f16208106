// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/external_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/sine_series.hpp"

namespace carrom {

namespace {

/// Solves (c[i - 1] + 4 c[i] + c[i + 1]) / 6 = f[i] with periodic indices, by the two recursive
/// filters of M. Unser, A. Aldroubi and M. Eden, IEEE Trans. Signal Process. 41, 821 (1993).
std::vector<double> round_coefficients(const std::vector<double>& f) {
    const double pole = std::sqrt(3.0) - 2;
    constexpr std::size_t far = 40; // pole^40 is below 2^-75
    const std::size_t n = f.size();
    std::vector<double> c(n);
    double sum = 0;
    for (std::size_t k = far + 1; k-- > 0;) sum = 6 * f[(n - k % n) % n] + pole * sum;
    c[0] = sum;
    for (std::size_t i = 1; i < n; ++i) c[i] = 6 * f[i] + pole * c[i - 1];
    const std::vector<double> forth = c;
    sum = 0;
    for (std::size_t k = far + 1; k-- > 0;) sum = -pole * forth[(n - 1 + k) % n] + pole * sum;
    c[n - 1] = sum;
    for (std::size_t i = n - 1; i-- > 0;) c[i] = pole * (c[i + 1] - forth[i]);
    return c;
}

/// Solves the same equations for a spline whose second derivative is 0 at both ends, so that c = f
/// there. The elimination needs no pivots, because the matrix is diagonally dominant.
std::vector<double> line_coefficients(const std::vector<double>& f) {
    const std::size_t n = f.size();
    std::vector<double> c = f, factor(n, 0.0);
    if (n < 3) return c;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double diagonal = 4 - factor[i - 1];
        factor[i] = i + 2 < n ? 1 / diagonal : 0;
        const double right = 6 * f[i] - (i + 2 == n ? f[n - 1] : 0);
        c[i] = (right - c[i - 1]) / diagonal;
    }
    for (std::size_t i = n - 2; i-- > 1;) c[i] -= factor[i] * c[i + 1];
    return c;
}

} // namespace

/// Weights of four coefficients, from index `first` on, for the spline's value and its derivative.
struct FieldSpline::Weights {
    std::size_t first = 0;
    std::array<double, 4> value{}, slope{};
};

std::vector<double> FieldSpline::coefficients_of(const std::vector<double>& numbers,
                                                 const Line& line) {
    const std::vector<double> c = line.goes_round ? round_coefficients(numbers)
                                                  : line_coefficients(numbers);
    const std::size_t n = c.size();
    std::vector<double> padded;
    padded.reserve(line.n_padded());
    padded.push_back(line.goes_round ? c[n - 1] : 2 * c[0] - c[1]);
    padded.insert(padded.end(), c.begin(), c.end());
    const double next = line.goes_round ? c[0] : 2 * c[n - 1] - c[n - 2];
    padded.push_back(next);
    padded.push_back(line.goes_round ? c[1 % n] : 2 * next - c[n - 1]);
    return padded;
}

FieldSpline::FieldSpline(const FieldValues& values, bool is_periodic_x, bool is_periodic_y) {
    if (values.numbers.empty()) return;
    Data data;
    data.x = {values.columns, is_periodic_x || values.columns == 1};
    data.y = {values.rows, is_periodic_y || values.rows == 1};
    const auto [low, high] = std::minmax_element(values.numbers.begin(), values.numbers.end());
    data.low = *low, data.high = *high;
    std::vector<std::vector<double>> rows;
    for (std::size_t row = 0; row < values.rows; ++row) {
        const double* const begin = values.numbers.data() + row * values.columns;
        rows.push_back(coefficients_of({begin, begin + values.columns}, data.x));
    }
    data.coefficients.resize(data.x.n_padded() * data.y.n_padded());
    for (std::size_t column = 0; column < data.x.n_padded(); ++column) {
        std::vector<double> along_y;
        for (const std::vector<double>& row : rows) along_y.push_back(row[column]);
        const std::vector<double> c = coefficients_of(along_y, data.y);
        for (std::size_t row = 0; row < c.size(); ++row)
            data.coefficients[row * data.x.n_padded() + column] = c[row];
    }
    data_ = std::make_shared<const Data>(std::move(data));
}

FieldSpline::Weights FieldSpline::weights_of(const Line& line, double place, double length) {
    const double n = line.n_intervals(), scale = n / length;
    double u = place * scale;
    if (line.goes_round) u -= n * std::floor(u / n);
    const double first = std::clamp(std::floor(u), 0.0, n - 1);
    const double t = std::clamp(u - first, 0.0, 1.0), beyond = (u - first) - t, r = 1 - t;
    Weights w;
    w.first = static_cast<std::size_t>(first);
    w.slope = {-r * r / 2, (3 * t - 4) * t / 2, (1 + (2 - 3 * t) * t) / 2, t * t / 2};
    w.value = {r * r * r / 6, (4 + (3 * t - 6) * t * t) / 6, (1 + (3 + (3 - 3 * t) * t) * t) / 6,
               t * t * t / 6};
    for (std::size_t k = 0; k < 4; ++k) {
        w.value[k] += beyond * w.slope[k];
        w.slope[k] *= scale;
    }
    return w;
}

FieldPoint FieldSpline::at(double x, double y, const Box& box) const {
    if (!data_) return {};
    const Weights wx = weights_of(data_->x, x, box.x), wy = weights_of(data_->y, y, box.y);
    FieldPoint sum;
    for (std::size_t j = 0; j < 4; ++j) {
        double value = 0, slope = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const double c = data_->at(wx.first + i, wy.first + j);
            value += wx.value[i] * c;
            slope += wx.slope[i] * c;
        }
        sum.energy += wy.value[j] * value;
        sum.slope_x += wy.value[j] * slope;
        sum.slope_y += wy.slope[j] * value;
    }
    return sum;
}

/// A second derivative is a weighted mean of second differences of coefficients, with weights >= 0.
/// The eigenvalues of the matrix of second derivatives are at most the sum of magnitudes in a row.
double FieldSpline::largest_curvature(const Box& box) const {
    if (!data_) return 0;
    const double hx = box.x / data_->x.n_intervals(), hy = box.y / data_->y.n_intervals();
    double xx = 0, yy = 0, xy = 0;
    const Data& c = *data_;
    for (std::size_t j = 0; j < c.y.n_padded(); ++j) {
        for (std::size_t i = 0; i < c.x.n_padded(); ++i) {
            if (i > 0 && i + 1 < c.x.n_padded())
                xx = std::max(xx, std::fabs(c.at(i - 1, j) - 2 * c.at(i, j) + c.at(i + 1, j)));
            if (j > 0 && j + 1 < c.y.n_padded())
                yy = std::max(yy, std::fabs(c.at(i, j - 1) - 2 * c.at(i, j) + c.at(i, j + 1)));
            if (i > 0 && j > 0)
                xy = std::max(xy, std::fabs((c.at(i, j) - c.at(i - 1, j)) -
                                            (c.at(i, j - 1) - c.at(i - 1, j - 1))));
        }
    }
    return std::max(xx / (hx * hx), yy / (hy * hy)) + xy / (hx * hy);
}

double FieldSpline::depth() const { return data_ ? data_->high - data_->low : 0; }

bool ExternalField::acts_along(Axis along) const {
    switch (kind) {
    case FieldKind::none: return false;
    case FieldKind::trap: return (along == Axis::x ? stiffness_x : stiffness_y) != 0;
    case FieldKind::sine: return along == axis;
    default: return (along == Axis::x ? values.columns : values.rows) > 1;
    }
}

double ExternalField::strength_of(DiscId id) const {
    if (ends.empty()) return 1;
    const auto species = std::upper_bound(ends.begin(), ends.end(), id) - ends.begin();
    return strengths[std::min(static_cast<std::size_t>(species), strengths.size() - 1)];
}

double ExternalField::largest_strength() const {
    double largest = strengths.empty() ? 1 : 0;
    for (const double strength : strengths) largest = std::max(largest, std::fabs(strength));
    return largest;
}

FieldPoint ExternalField::of_trap(double x, double y, const Box& box) const {
    const double from_x = x - centre_x.value_or(box.x / 2),
                 from_y = y - centre_y.value_or(box.y / 2);
    return {0.5 * (stiffness_x * from_x * from_x + stiffness_y * from_y * from_y),
            stiffness_x * from_x, stiffness_y * from_y};
}

FieldPoint ExternalField::of_sine(double place, double length) const {
    const double turns = static_cast<double>(waves) / length;
    const auto [sine, cosine] = sine_of_turns(place * turns + phase / two_pi);
    const double slope = amplitude * (two_pi * turns) * cosine;
    return {amplitude * sine, axis == Axis::x ? slope : 0, axis == Axis::x ? 0 : slope};
}

FieldPoint ExternalField::at(double x, double y, const Box& box) const {
    switch (kind) {
    case FieldKind::none: return {};
    case FieldKind::trap: return of_trap(x, y, box);
    case FieldKind::sine: return axis == Axis::x ? of_sine(x, box.x) : of_sine(y, box.y);
    default: break;
    }
    const FieldPoint point = spline.at(x, y, box);
    return {amplitude * point.energy, amplitude * point.slope_x, amplitude * point.slope_y};
}

double ExternalField::largest_curvature(const Box& box) const {
    switch (kind) {
    case FieldKind::none: return 0;
    case FieldKind::trap: return std::max(std::fabs(stiffness_x), std::fabs(stiffness_y));
    case FieldKind::sine: {
        const double number = two_pi * static_cast<double>(waves) / along(axis, box.x, box.y);
        return std::fabs(amplitude) * (number * number);
    }
    default: return std::fabs(amplitude) * spline.largest_curvature(box);
    }
}

double ExternalField::depth(const Box& box) const {
    switch (kind) {
    case FieldKind::none: return 0;
    case FieldKind::trap:
        return 0.125 * (std::fabs(stiffness_x) * (box.x * box.x) +
                        std::fabs(stiffness_y) * (box.y * box.y));
    case FieldKind::sine: return 2 * std::fabs(amplitude);
    default: return std::fabs(amplitude) * spline.depth();
    }
}

} // namespace carrom
