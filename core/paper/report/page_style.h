// Style sheet of the report for wide screens, narrow screens and print.
#pragma once

namespace stopline {

inline constexpr const char* kPageStyle = R"css(
:root { --ink: #1b1f24; --soft: #57606a; --line: #d0d7de; --band: #f6f8fa; --blue: #0b5394; --in: #00573f; --out: #9a3412; }
* { box-sizing: border-box; }
body { margin: 0; font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; color: var(--ink); background: #fff; }
.page { max-width: 76rem; margin: 0 auto; padding: 1rem 1.25rem 4rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 1rem 0 .5rem; }
h2 { font-size: 1.35rem; margin: 2.5rem 0 .75rem; padding-top: .5rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.08rem; margin: 1.75rem 0 .5rem; }
a { color: var(--blue); }
code { font: .88em/1.45 ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
pre { background: var(--band); border: 1px solid var(--line); border-radius: 6px; padding: .5rem .75rem; margin: .35rem 0;
      white-space: pre-wrap; overflow-wrap: anywhere; }
dl.facts { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; margin: .5rem 0; }
dl.facts dt { color: var(--soft); }
dl.facts dd { margin: 0; overflow-wrap: anywhere; }
.reduced { border: 2px solid #b00000; border-radius: 6px; background: #fff5f5; padding: .6rem .9rem; margin: 1rem 0; }
.badge { display: inline-block; border: 1px solid #b00000; color: #b00000; border-radius: 4px; padding: 0 .4rem; font-size: .8rem;
         font-weight: 600; vertical-align: middle; }
#answer li { margin: .3rem 0; }
.pictures { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1rem; margin: 1rem 0; }
.pictures a { border: 1px solid var(--line); border-radius: 6px; padding: .5rem; font-size: .88rem; text-decoration: none; }
.pictures img { display: block; width: 100%; height: auto; margin-bottom: .4rem; }
nav ol { columns: 2; column-gap: 2.5rem; padding-left: 1.4rem; margin: .5rem 0; }
nav li { break-inside: avoid; }
table { border-collapse: collapse; width: 100%; font-size: .88rem; margin: .5rem 0 1rem; }
caption { text-align: left; color: var(--soft); padding: .25rem 0; }
th, td { text-align: left; vertical-align: top; padding: .3rem .55rem; border-bottom: 1px solid var(--line); font-weight: 400; }
thead th { background: var(--band); font-weight: 600; border-bottom: 2px solid var(--line); }
tbody tr:nth-child(even) { background: #fbfcfd; }
td.number, thead th.number { text-align: right; font-variant-numeric: tabular-nums; }
td.words { min-width: 12rem; }
td.short { white-space: nowrap; }
.inside { color: var(--in); font-weight: 600; white-space: nowrap; }
.miss { color: var(--out); font-weight: 700; white-space: nowrap; }
.open { color: var(--soft); font-style: italic; white-space: nowrap; }
figure { margin: 1.25rem 0 2rem; border: 1px solid var(--line); border-radius: 6px; padding: .75rem 1rem; }
figure img { display: block; max-width: 100%; height: auto; margin: 0 auto .5rem; }
figcaption { font-size: .95rem; }
figcaption p { margin: .3rem 0; }
details { margin: .35rem 0; font-size: .85rem; }
summary { cursor: pointer; color: var(--blue); }
.links { font-size: .9rem; }
.problem { color: var(--out); font-weight: 600; }
ul.files { columns: 3; column-gap: 2rem; padding-left: 1.2rem; font-size: .9rem; }
footer { margin-top: 3rem; color: var(--soft); font-size: .88rem; border-top: 1px solid var(--line); padding-top: .75rem; }
@media screen and (max-width: 860px) {
  nav ol, ul.files { columns: 1; }
  dl.facts { grid-template-columns: 1fr; gap: 0; }
  dl.facts dd { margin: 0 0 .4rem; }
  .pictures { grid-template-columns: 1fr; }
  figure { padding: .5rem; }
}
@media screen and (max-width: 1180px) {
  table, tbody, tr, td, tbody th { display: block; width: 100%; }
  caption { display: block; }
  thead { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
  tbody tr { border: 1px solid var(--line); border-radius: 6px; margin: 0 0 .6rem; padding: .3rem .5rem; }
  th, td { border: 0; padding: .1rem 0; }
  tbody th { font-weight: 700; }
  td.number, thead th.number { text-align: left; }
  td.words { min-width: 0; }
  td:empty { display: none; }
  td[data-label]::before { content: attr(data-label) ": "; color: var(--soft); font-weight: 400; font-style: normal; }
}
@media print {
  @page { margin: 14mm; }
  body { font-size: 9.5pt; }
  .page { max-width: none; padding: 0; }
  h2 { break-before: page; border-top: 0; }
  h2, h3, caption { break-after: avoid; }
  figure { break-inside: avoid; border: 0; padding: 0; }
  figure img { max-height: 95mm; }
  tr { break-inside: avoid; }
  thead { display: table-header-group; }
  table { font-size: 7.8pt; }
  td.words { min-width: 0; }
  a { color: inherit; text-decoration: none; }
  .links, nav, ul.files { display: none; }
}
)css";

}  // namespace stopline
