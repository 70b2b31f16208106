// SPDX-License-Identifier: BSD-3-Clause
#include "apps/replicas/replicas_join.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "core/plain_file.hpp"
#include "measure/measurement.hpp"
#include "measure/order_watch.hpp"
#include "run/files/owned_files.hpp"
#include "run/files/report_file.hpp"
#include "run/files/run_folder.hpp"

namespace carrom {

namespace {

using Json = nlohmann::ordered_json;

/// Mean and standard error of the mean; NaN if there are too few numbers.
struct Mean {
    double value = NAN, error = NAN;
};

Mean mean_of(const std::vector<double>& numbers) {
    const auto n = static_cast<double>(numbers.size());
    double sum = 0, squares = 0;
    for (const double number : numbers) sum += number;
    const double mean = sum / n;
    for (const double number : numbers) squares += (number - mean) * (number - mean);
    return {mean, n > 1 ? std::sqrt(squares / (n * (n - 1))) : NAN};
}

bool differ_by_rounding(const Mean& mean, double scatter) {
    constexpr double rounding = 1e-12;
    return scatter <= rounding * std::fabs(mean.value);
}

/// A line for the terminal. If values differ only by rounding, it has no standard error.
std::string line_of(const std::string& name, const Mean& mean, double scatter) {
    if (differ_by_rounding(mean, scatter))
        return fmt::format("{:<20}{:.6g} in each\n", name, mean.value);
    return fmt::format("{:<20}{:.6g} +- {:.2g}\n", name, mean.value, mean.error);
}

Json or_null(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }
double number_of_json(const Json& json) { return json.is_number() ? json.get<double>() : NAN; }
std::string field(double number) { return std::isfinite(number) ? fmt::format("{}", number) : ""; }

/// An average in a report. `path` is the JSON pointer to an object with value and error, or to a
/// plain number.
struct AveragedColumn {
    std::string name, path;
};
std::vector<AveragedColumn> list_averaged_columns() {
    std::vector<AveragedColumn> columns = {
        {"temperature", "/temperature"},
        {"pressure", "/pressure"},
        {"compressibility", "/compressibility"},
        {"pressure_xx", "/pressure_tensor/xx"},
        {"pressure_xy", "/pressure_tensor/xy"},
        {"pressure_yy", "/pressure_tensor/yy"},
        {"collision_frequency", "/averages/collision_frequency"},
        {"mean_free_time", "/averages/mean_free_time"},
        {"wall_pressure", "/averages/wall_pressure"},
        {"mean_speed", "/averages/mean_speed"},
        {"speed_kurtosis", "/averages/speed_kurtosis"},
        {"kinetic_energy", "/kinetic_energy"},
    };
    for (const std::string name : OrderWatch::order_names)
        columns.push_back({name, "/watched/" + name});
    return columns;
}

const std::vector<AveragedColumn>& averaged_columns() {
    static const std::vector<AveragedColumn> columns = list_averaged_columns();
    return columns;
}

/// The `part` ("value" or "error") of an average; NaN if it is missing. A plain number has no
/// error.
double part_of(const Json& report, const AveragedColumn& quantity, const char* part) {
    const Json::json_pointer path(quantity.path);
    if (!report.contains(path)) return NAN;
    const Json& average = report.at(path);
    if (average.is_object()) return average.contains(part) ? number_of_json(average[part]) : NAN;
    return std::string_view(part) == "value" ? number_of_json(average) : NAN;
}

double value_in(const Json& report, const AveragedColumn& quantity) {
    return part_of(report, quantity, "value");
}

/// Compares the errors that replicas report with the scatter between replicas.
struct Claims {
    double claimed = NAN;       ///< root mean square of the reported errors; NaN if there are none
    double ratio = NAN;         ///< scatter divided by `claimed`
    std::size_t n_changing = 0; ///< replicas in which the average is still changing
    std::size_t n_silent = 0;   ///< other replicas without an error, mostly because they are short

    bool are_too_small(std::size_t n_replicas) const;
};

/// The chi squared per degree of freedom that is exceeded by chance in one of 1000 cases (Wilson
/// and Hilferty, Proc. Natl. Acad. Sci. 17, 684 (1931)).
double most_of_chi_squared(double freedom) {
    constexpr double deviations = 3.09;
    const double spread = 2 / (9 * freedom);
    return std::pow(1 - spread + deviations * std::sqrt(spread), 3);
}

/// Whether the reported errors are clearly too small. Errors from ten independent samples are on
/// average too small by more than a tenth (statistics/blocking.hpp), so a small excess of the
/// scatter does not justify a warning.
bool Claims::are_too_small(std::size_t n_replicas) const {
    constexpr double allowed = 1.15;
    return n_replicas > 1 &&
           ratio > allowed * std::sqrt(most_of_chi_squared(static_cast<double>(n_replicas - 1)));
}

Claims claims_of(const std::vector<Json>& reports, const AveragedColumn& quantity, double scatter) {
    Claims claims;
    double squares = 0, n = 0;
    for (const Json& report : reports) {
        const double error = part_of(report, quantity, "error");
        if (std::isfinite(error) && error > 0) squares += error * error, n += 1;
        const Json::json_pointer reason(quantity.path + "/without_error");
        if (!report.contains(reason) || !report.at(reason).is_string()) continue;
        const std::string text = report.at(reason).get<std::string>();
        const bool is_changing = text.starts_with("still changing");
        claims.n_changing += is_changing;
        claims.n_silent += !is_changing && text != "conserved";
    }
    if (n > 0) claims.claimed = std::sqrt(squares / n), claims.ratio = scatter / claims.claimed;
    return claims;
}

/// Collects signs that single runs are too short, and lists them in one warning.
class SingleRuns {
public:
    explicit SingleRuns(std::size_t n_replicas) : n_replicas_(n_replicas) {}

    void add(const std::string& name, const Claims& claims) {
        if (claims.are_too_small(n_replicas_))
            too_small_.push_back(fmt::format("{} {:.1f} times", name, claims.ratio));
        add(changing_, name, claims.n_changing);
        add(silent_, name, claims.n_silent);
    }

    std::string warning() const {
        std::vector<std::string> faults;
        const auto say = [&](const char* what, const std::vector<std::string>& names) {
            if (!names.empty())
                faults.push_back(fmt::format("{} ({})", what, fmt::join(names, ", ")));
        };
        say("replicas scatter more than their errors claim", too_small_);
        say("replicas are still changing", changing_);
        say("replicas are too short to claim an error", silent_);
        if (faults.empty()) return {};
        return fmt::format("single runs are shorter than their memory: {}; the errors over "
                           "replicas hold for runs of this length alone; try: longer runs",
                           fmt::join(faults, ", and "));
    }

private:
    void add(std::vector<std::string>& list, const std::string& name, std::size_t n) const {
        if (n * 4 > n_replicas_)
            list.push_back(fmt::format("{} in {} of {}", name, n, n_replicas_));
    }

    std::size_t n_replicas_;
    std::vector<std::string> too_small_, changing_, silent_;
};

Json read_report(const std::string& folder) {
    std::ifstream file = open_plain_file(report_of_run(folder));
    Json report = Json::parse(file, nullptr, false);
    const bool is_whole = report.is_object() && report.contains("state_hash") &&
                          report["state_hash"].is_string();
    if (!is_whole)
        throw InputError({{report_of_run(folder), 0, "is no whole report; remove it and go on"}});
    return report;
}

void write(const std::string& folder, const std::string& name, const std::string& text) {
    const auto path = std::filesystem::path(folder) / name;
    const std::string failure = write_whole_file(path.string(), text);
    if (!failure.empty()) throw CollectiveError(failure, ExitCode::output_failure);
}

constexpr const char *lines_begin = "replica,seed,state_hash",
                     *means_remark = "means over replicas, and their errors";

std::string remark_of_means(const std::string& table) {
    return fmt::format("# {}: {}\n", table, means_remark);
}

/// True unless the file has a name that replicas give to their results, but was written by another
/// program.
bool may_be_replaced(const std::filesystem::path& path) {
    const std::string name = path.filename().string(), stem = path.stem().string();
    if (name == "replicas.json") {
        const FileContent content = content_of(path.string());
        return content == FileContent::report || content == FileContent::nothing;
    }
    if (path.extension() != ".csv" || !(stem == "replicas" || is_name_of_table(stem))) return true;
    std::string line;
    std::ifstream file = open_plain_file(path.string());
    if (!std::getline(file, line)) return file.eof();
    return line.starts_with(lines_begin) || line + '\n' == remark_of_means(stem);
}

std::string lines_of_replicas(const std::vector<Replica>& replicas,
                              const std::vector<Json>& reports) {
    std::string text = lines_begin;
    for (const AveragedColumn& quantity : averaged_columns())
        text += fmt::format(",{}", quantity.name);
    for (std::size_t k = 0; k < reports.size(); ++k) {
        text += fmt::format("\n{},{},{}", k, replicas[k].seed,
                            reports[k]["state_hash"].get<std::string>());
        for (const AveragedColumn& quantity : averaged_columns())
            text += ',' + field(value_in(reports[k], quantity));
    }
    return text + '\n';
}

/// Whether a column contains the errors that each run estimated for another column.
bool is_error_of_run(const std::string& column, const Json& table) {
    return column.ends_with("_error") && table.contains(column.substr(0, column.size() - 6));
}

/// Means of a table over the replicas. A column `NAME_error` follows each column in which replicas
/// differ. The errors of single runs are averaged as `NAME_run_error`, so that no two columns have
/// the same name.
class JoinedTable {
public:
    JoinedTable(std::string name, const std::vector<Json>& reports) : name_(std::move(name)) {
        const Json& first = table_of(reports.front());
        for (const auto& [column, numbers] : first.items())
            if (column != "remarks") add_column(column, numbers.size(), reports);
    }

    bool is_whole() const { return is_whole_; }
    std::string csv() const {
        std::string text = remark_of_means(name_);
        for (std::size_t k = 0; k < columns_.size(); ++k)
            text += (k == 0 ? "" : ",") + columns_[k].name;
        for (std::size_t row = 0; !columns_.empty() && row < columns_[0].numbers.size(); ++row) {
            text += '\n';
            for (std::size_t k = 0; k < columns_.size(); ++k)
                text += (k == 0 ? "" : ",") + field(columns_[k].numbers[row]);
        }
        return text + '\n';
    }

private:
    struct Column {
        std::string name;
        std::vector<double> numbers;
    };

    const Json& table_of(const Json& report) const { return report["measurements"][name_]; }

    void add_column(const std::string& column, std::size_t n_rows,
                    const std::vector<Json>& reports) {
        Column means{column, {}}, errors{column + "_error", {}};
        const bool is_error = is_error_of_run(column, table_of(reports.front()));
        if (is_error) means.name.insert(column.size() - 6, "_run");
        for (const Json& report : reports) {
            const bool has_it = report.contains("measurements") &&
                                report["measurements"].contains(name_) &&
                                table_of(report).contains(column) &&
                                table_of(report)[column].is_array() &&
                                table_of(report)[column].size() == n_rows;
            is_whole_ = is_whole_ && has_it;
        }
        if (!is_whole_) return;
        bool are_alike = true;
        for (std::size_t row = 0; row < n_rows; ++row) {
            std::vector<double> numbers;
            for (const Json& report : reports)
                numbers.push_back(number_of_json(table_of(report)[column][row]));
            const Mean mean = mean_of(numbers);
            const bool is_one = std::equal(numbers.begin() + 1, numbers.end(), numbers.begin());
            are_alike = are_alike && is_one;
            means.numbers.push_back(is_one ? numbers.front() : mean.value);
            errors.numbers.push_back(mean.error);
        }
        columns_.push_back(std::move(means));
        if (!are_alike && !is_error) columns_.push_back(std::move(errors));
    }

    std::string name_;
    std::vector<Column> columns_;
    bool is_whole_ = true;
};

} // namespace

std::vector<Problem> problems_with_joined_files(const std::string& folder) {
    std::vector<Problem> problems;
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    for (const std::filesystem::directory_iterator end; !error && entry != end;
         entry.increment(error))
        if (!may_be_replaced(entry->path()))
            problems.push_back({entry->path().string(), 0,
                                "is no file of replicas, and these may write one of that name; "
                                "move it away"});
    return problems;
}

std::optional<std::int64_t> last_step_reported(const std::string& folder) {
    std::ifstream file = open_plain_file(report_of_run(folder));
    const Json report = Json::parse(file, nullptr, false);
    // A damaged report counts as missing: the replica continues from its checkpoint and writes a
    // new one.
    std::int64_t last = 0;
    for (const char* key : {"first_step", "steps"}) {
        if (!report.is_object() || !report.contains(key) || !report[key].is_number_integer())
            return std::nullopt;
        const auto number = report[key].get<std::int64_t>();
        if (number < 0 || number > std::numeric_limits<std::int64_t>::max() - last)
            return std::nullopt;
        last += number;
    }
    return last;
}

JoinedReplicas join_replicas(const std::vector<Replica>& replicas, const std::string& folder) {
    std::vector<Json> reports;
    for (const Replica& replica : replicas) reports.push_back(read_report(replica.folder));
    write(folder, "replicas.csv", lines_of_replicas(replicas, reports));
    std::string text = fmt::format("replicas           {}\n", replicas.size());
    Json joined = {{"replicas", replicas.size()}};
    SingleRuns runs(replicas.size());
    for (const AveragedColumn& quantity : averaged_columns()) {
        std::vector<double> values;
        for (const Json& report : reports) values.push_back(value_in(report, quantity));
        const Mean mean = mean_of(values);
        if (!std::isfinite(mean.value)) continue; // NaN if a replica does not report it
        const double scatter = mean.error * std::sqrt(static_cast<double>(replicas.size()));
        const Claims claims = claims_of(reports, quantity, scatter);
        joined[quantity.name] = {{"value", mean.value},
                                 {"error", or_null(mean.error)},
                                 {"claimed", or_null(claims.claimed)},
                                 {"scatter_over_claimed", or_null(claims.ratio)},
                                 {"still_changing", claims.n_changing}};
        text += line_of(quantity.name, mean, scatter);
        if (!differ_by_rounding(mean, scatter)) runs.add(quantity.name, claims);
    }
    write(folder, "replicas.json", joined.dump(2) + '\n');
    if (reports.front().contains("measurements"))
        for (const auto& [name, table] : reports.front()["measurements"].items()) {
            const JoinedTable means(name, reports);
            if (means.is_whole()) write(folder, name + ".csv", means.csv());
        }
    return {text, runs.warning()};
}

} // namespace carrom
