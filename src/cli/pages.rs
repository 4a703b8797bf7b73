//! Completion scripts and the manual page, made from the table of flags.

use super::args::{CERTIFY_EXAMPLES, Cli, EXIT_CODES};
use super::output;
use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;
use sigmastar::Verdict;

/// Writes the completion script of a shell; returns the exit code.
pub fn completions(shell: Shell) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "sigmastar", &mut script);
    write(&script)
}

/// Writes the manual page, one for all commands; returns the exit code.
pub fn man() -> u8 {
    match page() {
        Ok(page) => write(&page),
        // Writing to memory does not fail.
        Err(_) => Verdict::BadInput.exit_code(),
    }
}

/// The manual page: the command itself, then a section for each of its commands.
fn page() -> std::io::Result<Vec<u8>> {
    let mut command = Cli::command();
    command.build();
    let main = Man::new(command.clone());
    let mut page = Vec::new();
    main.render_title(&mut page)?;
    main.render_name_section(&mut page)?;
    main.render_synopsis_section(&mut page)?;
    main.render_options_section(&mut page)?;
    for part in command.get_subcommands().filter(|part| part.get_name() != "help") {
        let man = Man::new(part.clone());
        let mut section = Vec::new();
        man.render_synopsis_section(&mut section)?;
        man.render_description_section(&mut section)?;
        man.render_options_section(&mut section)?;
        page.extend(format!(".SH COMMAND {}\n", part.get_name().to_uppercase()).bytes());
        // Its sections are parts of one section here.
        page.extend(String::from_utf8_lossy(&section).replace(".SH ", ".SS ").bytes());
    }
    page.extend(b".SH EXAMPLES\n.nf\n");
    page.extend(CERTIFY_EXAMPLES.replace('-', "\\-").lines().skip(1).flat_map(|line| format!("{line}\n").into_bytes()));
    page.extend(b".fi\n.SH EXIT STATUS\n.nf\n");
    page.extend(EXIT_CODES.replace('-', "\\-").lines().skip(1).flat_map(|line| format!("{line}\n").into_bytes()));
    page.extend(b".fi\n");
    Ok(page)
}

fn write(bytes: &[u8]) -> u8 {
    output::data(&String::from_utf8_lossy(bytes)).err().unwrap_or(0)
}
