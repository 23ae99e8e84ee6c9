//! Colours and strokes, as CSS: light and dark.

/// How many colours series have.
pub(super) const COLOURS: usize = 6;

/// What a page with plots has in its head. Series' colours are told apart by people who see red and green alike (after
/// Okabe and Ito), and have a contrast of 3 at least with the ground they lie on.
pub const STYLE: &str = "\
.plot{--ground:#ffffff;--ink:#1c1f24;--soft:#5c6470;--grid:#dde1e6;\
--c0:#0067a8;--c1:#c04a00;--c2:#00785a;--c3:#a8478a;--c4:#8a6a00;--c5:#4b5563;\
font-family:system-ui,'DejaVu Sans',sans-serif;font-size:12px}
@media (prefers-color-scheme:dark){.plot{--ground:#15181d;--ink:#e8eaee;--soft:#a4acb8;--grid:#323842;\
--c0:#5db4ee;--c1:#ff9153;--c2:#3fcf9f;--c3:#e594c8;--c4:#e6c04d;--c5:#b4bcc8}}
.plot .ground{fill:var(--ground)}
.plot text{fill:var(--ink)}
.plot .soft{fill:var(--soft)}
.plot .title{font-size:14px;font-weight:600}
.plot .grid{stroke:var(--grid);stroke-width:1;fill:none}
.plot .axis{stroke:var(--soft);stroke-width:1;fill:none}
.plot .line{fill:none;stroke-width:2;stroke-linejoin:round}
.plot .Dashed{stroke-dasharray:8 4}
.plot .Dotted{stroke-dasharray:1.5 4;stroke-linecap:round}
.plot .mark{stroke-width:1;stroke-dasharray:3 3}
.plot .sign{stroke-width:1.5}
.plot .hollow{fill:var(--ground)}
.plot .c0{stroke:var(--c0)}.plot .c1{stroke:var(--c1)}.plot .c2{stroke:var(--c2)}
.plot .c3{stroke:var(--c3)}.plot .c4{stroke:var(--c4)}.plot .c5{stroke:var(--c5)}
.plot .full.c0{fill:var(--c0)}.plot .full.c1{fill:var(--c1)}.plot .full.c2{fill:var(--c2)}
.plot .full.c3{fill:var(--c3)}.plot .full.c4{fill:var(--c4)}.plot .full.c5{fill:var(--c5)}
.plot .around{fill:transparent;stroke:none}.plot .point{cursor:pointer;outline:none}
.plot .point:hover .sign,.plot .point:focus .sign,.plot .point.chosen .sign{stroke-width:4}
.plot .names text{font-size:11px;pointer-events:none;stroke:var(--ground);stroke-width:3;paint-order:stroke}
.plot .ink{stroke:var(--soft)}
";
