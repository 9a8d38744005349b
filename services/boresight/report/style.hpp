// Layout and colours of the page. Charts carry their own (services/boresight/svg/style.hpp).
#pragma once

namespace boresight::report {

inline constexpr const char* kStyle = R"(
:root { color-scheme: light; --ink: #1c2430; --faint: #5c6675; --line: #d9dee6; --card: #f6f8fa; --good: #2e8b57;
  --warn: #b87400; --bad: #c93a3a; }
body { background: #ffffff; color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; margin: 0 auto;
  max-width: 1080px; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0; } h2 { font-size: 18px; margin: 38px 0 6px; } p { margin: 4px 0 12px; }
.faint { color: var(--faint); }
.verdict { border-left: 5px solid var(--good); background: var(--card); padding: 10px 16px; margin: 18px 0; }
.verdict.bad { border-color: var(--bad); color: inherit; font-weight: inherit; }
.verdict b { font-size: 17px; } .verdict ul { margin: 6px 0 0; padding-left: 20px; }
summary { cursor: pointer; color: var(--faint); } dl { margin: 8px 0 0; display: grid; gap: 4px 16px;
  grid-template-columns: max-content 1fr; font-size: 14px; } dt { font-weight: 600; } dd { margin: 0; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th { text-align: left; color: var(--faint); font-weight: 500; font-size: 13px; }
td, th { padding: 5px 12px 5px 0; border-bottom: 1px solid var(--line); }
td.n, th.n { text-align: right; } td.n { white-space: nowrap; } .wide { overflow-x: auto; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; } .warn { color: var(--warn); }
.grid2 { display: grid; grid-template-columns: 1fr 1fr; gap: 10px 22px; } .grid2 h3 { font-size: 14px; margin: 6px 0 0; }
@media (max-width: 760px) { .grid2 { grid-template-columns: 1fr; } }
.chart { width: 100%; height: auto; display: block; }
.key { display: inline-block; width: 24px; height: 10px; margin: 0 5px 0 14px; }
td.heat { background: color-mix(in srgb, var(--heat) calc(var(--share) * 55%), transparent); padding-right: 8px; }
td.right { --heat: #0072b2; } td.wrong { --heat: #d98200; }
.legend { color: var(--faint); font-size: 13px; }
pre { background: var(--card); padding: 12px 14px; overflow-x: auto; font-size: 12.5px; line-height: 1.45; }
)";

}  // namespace boresight::report
