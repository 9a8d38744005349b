// How the page looks, in light and dark.
#pragma once

namespace boresight::report {

inline constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1c2430; --faint: #5c6675; --line: #d9dee6; --card: #f6f8fa;
  --blue: #2563b8; --band: #2563b826; --good: #2e8b57; --warn: #c98500; --bad: #c93a3a; --idle: #b9c1cc; --truth: #8a3fb0;
  --moving: #0072b2; --type1: #d98200; --type2: #b8478f; --clutter: #00805f; --still: #8b95a3; }
@media (prefers-color-scheme: dark) { :root { --paper: #14181e; --ink: #e4e8ee; --faint: #9aa5b4; --line: #323a46;
  --card: #1b2129; --blue: #6ea8ff; --band: #6ea8ff2e; --good: #4cc38a; --warn: #e5a63a; --bad: #f26d6d; --idle: #4a5462;
  --truth: #c893ee; --moving: #56b4e9; --type1: #f0ae2e; --type2: #e58bc0; --clutter: #2fc79a; --still: #76818f; } }
body { background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; margin: 0 auto;
  max-width: 1080px; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0; } h2 { font-size: 18px; margin: 38px 0 6px; } p { margin: 4px 0 12px; }
.faint { color: var(--faint); }
.verdict { border-left: 5px solid var(--good); background: var(--card); padding: 10px 16px; margin: 18px 0; }
.verdict.bad { border-color: var(--bad); color: inherit; font-weight: inherit; }
.verdict b { font-size: 17px; } .verdict ul { margin: 6px 0 0; padding-left: 20px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th { text-align: left; color: var(--faint); font-weight: 500; font-size: 13px; }
td, th { padding: 5px 12px 5px 0; border-bottom: 1px solid var(--line); }
td.n, th.n { text-align: right; } .wide { overflow-x: auto; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; } .warn { color: var(--warn); }
.grid2 { display: grid; grid-template-columns: 1fr 1fr; gap: 10px 22px; } .grid2 h3 { font-size: 14px; margin: 6px 0 0; }
@media (max-width: 760px) { .grid2 { grid-template-columns: 1fr; } }
.chart { width: 100%; height: auto; display: block; }
.chart text { fill: var(--faint); font-size: 11px; } .chart text.name { fill: var(--ink); font-size: 12px; }
.chart .grid { stroke: var(--line); stroke-width: 1; } .chart .frame { fill: none; stroke: var(--line); }
.chart .estimate { stroke: var(--blue); stroke-width: 2; } .chart .sigma { fill: var(--band); }
.chart .truth { stroke: var(--truth); stroke-width: 1.5; stroke-dasharray: 6 4; }
.chart .limit { stroke: var(--bad); stroke-width: 1; stroke-dasharray: 2 4; }
.chart .mark { stroke: var(--faint); stroke-width: 1; stroke-dasharray: 4 3; }
.chart .g { fill: var(--good); } .chart .w { fill: var(--warn); } .chart .b { fill: var(--bad); } .chart .i { fill: var(--idle); }
.chart .bar { fill: var(--blue); } .chart .car { fill: var(--ink); } .chart .fov { fill: var(--band); stroke: none; }
.chart .trail { stroke-width: 1.6; opacity: 0.75; } .chart .t0 { stroke: var(--blue); } .chart .t1 { stroke: var(--good); }
.chart .t2 { stroke: var(--warn); } .chart .t3 { stroke: var(--truth); } .chart .t4 { stroke: var(--bad); }
.chart .head { fill: var(--ink); }
.chart .l1 { fill: var(--moving); } .chart .l3 { fill: var(--type1); } .chart .l4 { fill: var(--type2); }
.chart .l5, .chart .l2, .chart .l0, .chart .lx { fill: none; stroke-width: 1.6; }
.chart .l5 { stroke: var(--clutter); } .chart .l2 { stroke: var(--still); } .chart .l0 { stroke: var(--ink); }
.chart .lx { stroke: var(--still); stroke-width: 1; }
.chart .area5 { fill: var(--clutter); }
.chart .wrong { fill: none; stroke: var(--ink); stroke-width: 1.3; }
.chart .segment { stroke: var(--ink); stroke-width: 2.5; opacity: 0.55; }
.chart .box { fill: none; stroke: var(--ink); stroke-width: 1.4; }
.chart .truebox { fill: var(--band); stroke: var(--truth); stroke-width: 1.2; stroke-dasharray: 4 3; }
.chart .sensor { fill: var(--bad); stroke: var(--paper); stroke-width: 1; }
.chart.key { display: inline-block; width: 14px; height: 14px; margin: 0 5px 0 14px; vertical-align: -2px; }
td.heat { background: color-mix(in srgb, var(--heat) calc(var(--share) * 55%), transparent); }
td.right { --heat: var(--moving); } td.wrong { --heat: var(--type1); }
td.heat { padding-right: 8px; }
.legend { color: var(--faint); font-size: 13px; } .legend i { display: inline-block; width: 22px; height: 0; margin: 0 5px 4px 14px;
  border-top: 2px solid var(--blue); vertical-align: middle; } .legend i.truth { border-top: 2px dashed var(--truth); }
.legend i.t1 { border-color: var(--good); }
.legend i.t2 { border-color: var(--warn); } .legend i.t3 { border-color: var(--truth); } .legend i.t4 { border-color: var(--bad); }
.legend i.limit { border-top: 2px dotted var(--bad); } .legend i.box { height: 10px; border: 0; }
pre { background: var(--card); padding: 12px 14px; overflow-x: auto; font-size: 12.5px; line-height: 1.45; }
)";

}  // namespace boresight::report
