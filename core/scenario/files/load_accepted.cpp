#include "scenario/files/load_accepted.h"

#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/read_fields.h"
#include "scenario/schema/report.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {
namespace {

const Table& difference_table() {
    using S = AcceptedDifference;
    static const Table table = make_table<S>(
        "a detector in a permutation",
        {
            text<&S::permutation>("permutation", TextField::Rule::title, "values of the axes, as in the report")
                .required(),
            text<&S::detector>("detector", TextField::Rule::title, "name of the detector, as in the report").required(),
            text<&S::reason>("reason", TextField::Rule::title, "reason why the differences are accepted").required(),
        });
    return table;
}

}  // namespace

const Table& accepted_table() {
    static const Table table = make_table<AcceptedFile>(
        "accepted differences", {list<&AcceptedFile::accepted>("accepted", difference_table, {1, 10'000},
                                                               "detectors whose differences count as valid")});
    return table;
}

AcceptedFile load_accepted(const std::filesystem::path& file) {
    Report report;
    AcceptedFile accepted;
    read_fields(accepted_table(), read_yaml_file(file), "", &accepted, report);
    report.throw_if_any();
    for (std::size_t i = 0; i < accepted.accepted.size(); ++i) {
        const std::string entry = "accepted[" + std::to_string(i) + "]";
        accepted.accepted[i].permutation_place = to_string(report.place_of(entry + ".permutation"));
        accepted.accepted[i].detector_place = to_string(report.place_of(entry + ".detector"));
    }
    return accepted;
}

}  // namespace stopline
