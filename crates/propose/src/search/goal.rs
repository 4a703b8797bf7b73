//! What the shape of an error box is chosen for (derivation, 13.5).

/// What is made small over the shapes of an error box; of all but the first one at a gain that is given, where the threshold is below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Goal {
    /// The threshold of the gain, or the radius of the forms at samples: for the smallest gain.
    #[default]
    Threshold,
    /// How far u goes from that of the periodic solution.
    Control,
    /// How far e goes from that of the periodic solution.
    Peak,
}
