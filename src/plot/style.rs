//! Colours, light and dark.
//!
//! A plot's elements carry the light colours as attributes, which every viewer of SVG knows. A style replaces them on a
//! dark ground; a viewer that knows no style, or no media query, shows the light ones.

/// The colours of a plot.
pub(super) struct Palette {
    pub(super) ground: &'static str,
    pub(super) ink: &'static str,
    pub(super) soft: &'static str,
    pub(super) grid: &'static str,
    /// People who see red and green alike can tell these apart (after Okabe and Ito), and their contrast with the
    /// ground is 3 at least.
    series: [&'static str; 6],
}

pub(super) const LIGHT: Palette = Palette {
    ground: "#ffffff",
    ink: "#1c1f24",
    soft: "#5c6470",
    grid: "#dde1e6",
    series: ["#0067a8", "#c04a00", "#00785a", "#a8478a", "#8a6a00", "#4b5563"],
};

impl Palette {
    /// The number of a series' colour in the palette.
    pub(super) const fn place(&self, colour: usize) -> usize {
        colour % self.series.len()
    }

    /// The colour of a series.
    pub(super) const fn series(&self, colour: usize) -> &'static str {
        self.series[self.place(colour)]
    }
}

/// The fonts of a plot.
pub(super) const FONT: &str = "system-ui,'DejaVu Sans',sans-serif";

/// What a page with plots has in its head.
pub const STYLE: &str = "\
.plot .point{cursor:pointer;outline:none}.plot .names text{pointer-events:none}
.plot .point:hover .sign,.plot .point:focus .sign,.plot .point.chosen .sign{stroke-width:4}
@media (prefers-color-scheme:dark){
.plot .ground,.plot .hollow{fill:#15181d}.plot text{fill:#e8eaee}.plot .soft{fill:#a4acb8}
.plot .halo{fill:#15181d;stroke:#15181d}.plot .grid{stroke:#323842}.plot .axis,.plot .ink{stroke:#a4acb8}
.plot .c0{stroke:#5db4ee}.plot .c1{stroke:#ff9153}.plot .c2{stroke:#3fcf9f}
.plot .c3{stroke:#e594c8}.plot .c4{stroke:#e6c04d}.plot .c5{stroke:#b4bcc8}
.plot .full.c0{fill:#5db4ee}.plot .full.c1{fill:#ff9153}.plot .full.c2{fill:#3fcf9f}
.plot .full.c3{fill:#e594c8}.plot .full.c4{fill:#e6c04d}.plot .full.c5{fill:#b4bcc8}
}
";
