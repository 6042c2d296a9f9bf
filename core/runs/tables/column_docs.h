// Descriptions of all columns of all result tables. columns_markdown() makes the page scenarios/COLUMNS.md from them.
// The columns of summary.csv and of sweeps are described by the entries of the metrics (runs/metrics/metric.h).
//
// The name of a table is its group and its file, such as "network/summary.csv". The group is the kind of network or the
// program that writes the table. CAPITALS in names stand for varying parts, such as the NAME of a sweep.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

struct ColumnDoc {
    std::string name;
    std::string unit;    // empty: no unit
    std::string extent;  // part of the run that the value covers; empty: not applicable
    std::string meaning;
};

struct TableDoc {
    std::string_view name;
    std::string_view rows;  // meaning of a row, and the runs for which the file is written
    std::vector<ColumnDoc> columns;
};

// The first column of most tables.
inline const ColumnDoc kPopulationColumn{"population", "", "", "name of the population"};

// The column that names a vehicle as VehicleNames does.
inline const ColumnDoc kVehicleColumn{"vehicle", "", "", "number of the vehicle; SUMO's id in imported networks"};

// Returns kPopulationColumn followed by `columns`.
std::vector<ColumnDoc> with_population(const std::vector<ColumnDoc>& columns);

// Returns the descriptions of all tables, in the order of scenarios/COLUMNS.md.
const std::vector<TableDoc>& table_docs();

// Returns the group of the tables that stopline-run writes for a network, such as "intersection".
std::string table_group(const NetworkSettings& network);

// Each of these functions returns the descriptions of some tables, for instance of one group.
std::vector<TableDoc> network_table_docs();
std::vector<TableDoc> intersection_table_docs();
std::vector<TableDoc> single_light_table_docs();
std::vector<TableDoc> driving_table_docs();
std::vector<TableDoc> sweep_table_docs();
std::vector<TableDoc> string_table_docs();
std::vector<TableDoc> hcm_table_docs();
std::vector<TableDoc> program_table_docs();  // see program_columns.cpp

// Returns the description of a column. Throws std::logic_error if there is none.
ColumnDoc column_doc(const std::vector<TableDoc>& tables, std::string_view table, std::string_view column);

// Returns the section of a table on the page.
std::string table_markdown(const TableDoc& table);

// Returns the text of scenarios/COLUMNS.md.
std::string columns_markdown();

}  // namespace stopline
