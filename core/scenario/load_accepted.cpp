#include "scenario/load_accepted.h"

#include "scenario/field_rows.h"
#include "scenario/fields.h"
#include "scenario/read_fields.h"
#include "scenario/report.h"
#include "scenario/yaml_source.h"

namespace stopline {
namespace {

const Table& difference_table() {
    using S = AcceptedDifference;
    static const Table table = make_table<S>(
        "a detector of a permutation",
        {
            text<&S::permutation>("permutation", TextField::Rule::title, "values of the axes, as in the report")
                .required(),
            text<&S::detector>("detector", TextField::Rule::title, "name, as in the report").required(),
            text<&S::reason>("reason", TextField::Rule::title, "why its differences are accepted").required(),
        });
    return table;
}

}  // namespace

const Table& accepted_table() {
    static const Table table = make_table<AcceptedFile>(
        "accepted differences", {list<&AcceptedFile::accepted>("accepted", difference_table, {1, 10'000},
                                                               "detectors of permutations that count as valid")});
    return table;
}

AcceptedFile load_accepted(const std::filesystem::path& file) {
    Report report;
    AcceptedFile accepted;
    read_fields(accepted_table(), read_yaml_file(file), "", &accepted, report);
    report.throw_if_any();
    return accepted;
}

}  // namespace stopline
