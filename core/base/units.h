// Unit conversions and physical constants. Inside Stopline every quantity is in SI units. Quantities in other units
// occur in scenario files, tables and figures. They are converted on reading or writing.
#pragma once

namespace stopline {

inline constexpr double kMpsPerKmh = 1.0 / 3.6;
inline constexpr double kKmhPerMps = 3.6;
inline constexpr double kSecondsPerHour = 3600.0;
inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadpsPerRpm = kPi / 30.0;
inline constexpr double kGravity_mps2 = 9.80665;     // standard gravity, ISO 80000-3
inline constexpr double kAirDensity_kgpm3 = 1.2041;  // dry air at 20 degrees Celsius and 101,325 Pa

}  // namespace stopline
