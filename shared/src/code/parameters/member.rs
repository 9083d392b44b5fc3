//! What the names of members and columns are in four languages.

use alloc::string::String;

/// A member of the configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Member {
    Name,
    Cancel,
    TriggerType,
    StrMode,
    Service,
    Class,
    Instance,
    Attribute,
    Count,
    Ids,
    IdAt(usize),
    Path,
    CipConnMode,
    UcmmTimeout,
    ConnMsgTimeout,
    ConnClose,
    ReqData,
    ReqLength,
    ResData,
    /// A parameter that is not stored: an output, a structure as a whole.
    Nothing,
}

/// By its name, without accents, case, spaces and what stands before a dot.
pub(super) fn member(name: &str) -> Option<Member> {
    let name = name.rsplit('.').next().unwrap_or(name);
    // `MemberId[0] := 1` is an assignment of a program.
    if name.contains(":=") {
        return None;
    }
    let plain: String = name.chars().filter_map(plain).collect();
    if let Some(at) = plain.strip_prefix("memberid").and_then(|at| at.parse().ok()) {
        return (at < 3).then_some(Member::IdAt(at));
    }
    Some(match plain.as_str() {
        "name" | "nome" | "nombre" | "block" | "bloco" | "bloque" | "baustein" => Member::Name,
        "cancel" | "cancelar" | "abbrechen" | "abbruch" => Member::Cancel,
        "triggertype" | "tipodedisparo" | "triggertyp" => Member::TriggerType,
        "strmode" => Member::StrMode,
        "service" | "servico" | "servicio" | "dienst" | "servicecode" | "codigodeservico"
        | "codigodeservicio" => Member::Service,
        "class" | "classe" | "clase" | "klasse" | "classid" => Member::Class,
        "instance" | "instancia" | "instanz" | "instanceid" => Member::Instance,
        "attribute" | "atributo" | "attribut" | "attributeid" => Member::Attribute,
        "membercnt" => Member::Count,
        "memberid" => Member::Ids,
        "path" | "caminho" | "ruta" | "pfad" => Member::Path,
        "cipconnmode" => Member::CipConnMode,
        "ucmmtimeout" => Member::UcmmTimeout,
        "connmsgtimeout" => Member::ConnMsgTimeout,
        "connclose" => Member::ConnClose,
        "reqdata" => Member::ReqData,
        "reqlength" => Member::ReqLength,
        "resdatasize" => Member::ResData,
        "resdata" | "in" | "q" | "status" | "reslength" | "ctrlcfg" | "appcfg" | "targetcfg" | "erro"
        | "error" | "errorid" | "suberrorid" | "exterrorid" | "statusbits" => Member::Nothing,
        _ => return None,
    })
}

/// Letters and digits alone; the accents of the four languages are taken off.
fn plain(c: char) -> Option<char> {
    let c = match c {
        'á' | 'à' | 'â' | 'ã' | 'Á' | 'Â' | 'Ã' | 'ä' | 'Ä' => 'a',
        'é' | 'ê' | 'É' | 'Ê' => 'e',
        'í' | 'Í' => 'i',
        'ó' | 'ô' | 'õ' | 'Ó' | 'ö' | 'Ö' => 'o',
        'ú' | 'Ú' | 'ü' | 'Ü' => 'u',
        'ç' | 'Ç' => 'c',
        'ñ' | 'Ñ' => 'n',
        c => c.to_ascii_lowercase(),
    };
    c.is_ascii_alphanumeric().then_some(c)
}

/// The head of a table.
pub(super) struct Head {
    /// The column of the values.
    pub(super) value: Option<usize>,
}

/// Whether the columns are a head: the first is a word for parameter, and no member; or a word for name, with a column
/// for types or initial values beside it, as in tables of variables.
pub(super) fn head_of(columns: &[&str]) -> Option<Head> {
    let plain = |cell: &&str| cell.chars().filter_map(plain).collect::<String>();
    let mut words = columns.iter().map(plain).filter(|word| !word.is_empty());
    let first = words.next()?;
    let is_head = matches!(
        first.as_str(),
        "parametro" | "parameter" | "member" | "membro" | "miembro" | "campo" | "feld" | "elemento"
    );
    let is_name = matches!(first.as_str(), "name" | "nome" | "nombre" | "variable" | "variavel" | "tag");
    let is_column = |word: &str| {
        matches!(
            word,
            "datatype"
                | "type"
                | "tipo"
                | "tipodedados"
                | "tipodedatos"
                | "datentyp"
                | "typ"
                | "initialvalue"
                | "valorinicial"
                | "anfangswert"
                | "initialwert"
        )
    };
    let value = |cell: &&str| {
        matches!(
            plain(cell).as_str(),
            "value" | "valor" | "wert" | "initialvalue" | "valorinicial" | "anfangswert" | "initialwert"
        )
    };
    let is_table = is_head || is_name && words.any(|word| is_column(&word));
    is_table.then(|| Head { value: columns.iter().position(value) })
}

/// `---+---`, `|---|---|`
pub(in crate::code) fn is_rule(line: &str) -> bool {
    let line = line.trim();
    line.contains("---") && line.chars().all(|c| "|-+: ".contains(c))
}

/// The value where no head has told its column: the last cell, unless that is the type or a description. Of more
/// than two cells a description may be the last one: the first that can be a value is taken.
pub(super) fn value<'a>(member: Member, cells: &[&'a str]) -> Option<&'a str> {
    let rest = cells.get(1..)?;
    let is_type = |cell: &&&str| {
        let word = cell.split(['[', '(']).next().unwrap_or_default().trim();
        matches!(
            word.to_ascii_uppercase().as_str(),
            "BOOL"
                | "USINT"
                | "UINT"
                | "UDINT"
                | "STRING"
                | "INPUT"
                | "OUTPUT"
                | "ENTRADA"
                | "SAIDA"
                | "SAÍDA"
                | "SALIDA"
                | "EINGANG"
                | "AUSGANG"
        )
    };
    let mut values = rest.iter().filter(|cell| !is_type(cell));
    let text = matches!(member, Member::Name | Member::Path | Member::ReqData | Member::Ids);
    let is_value = |cell: &&&str| {
        text || cell.chars().all(|c| c.is_ascii_alphanumeric() || c == '#' || c == '-' || c == '_')
    };
    values.find(is_value).copied()
}
