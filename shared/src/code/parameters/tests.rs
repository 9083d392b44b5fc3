use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::*;
use crate::plan::MessagePlan;

fn requests(imported: &Imported) -> Vec<String> {
    let one = |found: &Found| {
        let plan = MessagePlan::of(&found.config).0.expect("a plan");
        format!("{:?} {} {}", found.lines, plan.target(), write_hex(plan.bytes()))
    };
    imported.blocks.iter().map(one).collect()
}

fn told(imported: &Imported) -> Vec<String> {
    let blocks = imported.blocks.iter().flat_map(|found| &found.remarks);
    imported.remarks.iter().chain(blocks).map(ToString::to_string).collect()
}

#[test]
fn the_columns_of_the_portuguese_document_are_read() {
    let text = "Parâmetro\tTipo de dados\tValor\tDescrição
Serviço\tUSINT\t14\tCódigo de serviço
Classe\tUINT\t1\tValor do ID de classe
Instância\tUDINT\t1\t
Atributo\tUINT\t7\t0 - Nenhum
MemberCnt\tUSINT\t0\t
Caminho\tSTRING[80]\t\"4,192.168.1.100\"\tCaminho para o destino
UcmmTimeout\tUDINT\t500\tms
Parâmetro\tTipo de dados\tValor\tDescrição
Serviço\tUSINT\t16#10\t
Classe\tUINT\t0x93\t
Instância\tUDINT\t41\t
Atributo\tUINT\t9\t
ReqData\tUSINT[1..1]\tE8 03\t
Caminho\tSTRING[80]\t4,192.168.1.20\t
";
    let imported = import(text);
    assert_eq!(
        requests(&imported),
        [
            "2..9 192.168.1.100:44818 0e03200124013007",
            "10..16 192.168.1.20:44818 10032093242930 09e803"
                .replacen(' ', "§", 2)
                .replace(' ', "")
                .replace('§', " ")
                .as_str()
        ]
    );
    assert_eq!(told(&imported), Vec::<String>::new());
    assert_eq!(imported.blocks[0].config.as_msg().unwrap().target_cfg.ucmm_timeout, 500);
}

#[test]
fn every_separator_and_language_is_read() {
    for text in [
        "| Parameter | Value |\n|---|---|\n| Service | 14 |\n| Class | 1 |\n| Instance | 1 |\n| Attribute | 7 |\n| Path | 4,10.0.0.1 |",
        "Servicio;14\nClase;1\nInstancia;1\nAtributo;7\nRuta;4,10.0.0.1",
        "Dienst    14\nKlasse    1\nInstanz   1\nAttribut  7\nPfad      4,10.0.0.1",
        "AppCfg.Service = 14\nAppCfg.Class = 1\nAppCfg.Instance = 1\nAppCfg.Attribute = 7\nTargetCfg.Path = '4,10.0.0.1'",
        "Serviço\tUSINT\t14\nClasse\tUINT\t1\nInstância\tUDINT\t1\nAtributo\tUINT\t7\nCaminho\tSTRING[80]\t4,10.0.0.1",
    ] {
        let imported = import(text);
        assert!(requests(&imported)[0].ends_with("10.0.0.1:44818 0e03200124013007"), "{text}");
        assert_eq!(told(&imported), Vec::<String>::new(), "{text}");
        assert!(text.lines().all(|line| is_row(line) || is_rule(line)), "{text}");
    }
}

#[test]
fn what_is_not_known_is_told_at_its_row() {
    let imported = import("Service\t1x\nClass\t1\nColour\tred\nInstance\nMemberId[1]\t5\nQ\tBOOL");
    assert_eq!(
        told(&imported),
        [
            "3:1: error: Colour is not known, left out: Colour\tred",
            "1:9: error: Service: not a number; write 147, 0x93, 93h or 16#93: Service\t1x",
            "4:1: error: the value of Instance is missing: Instance",
            "6:1: note: Q changes nothing about the message: Q\tBOOL",
            "1:1: warning: the text names no device: the path is 0,0, the built-in simulated device; write where it goes: \
             Service\t1x",
        ]
    );
    assert!(!is_row("a := 5;") && !is_row("Service") && !is_row("0E 03 20"));
}

#[test]
fn a_table_of_variables_is_read_by_its_column_of_initial_values() {
    let text = "Name\tAlias\tData Type\tDimension\tInitial Value\tComment
AppCfg\t\tCIPAPPCFG\t\t\t
AppCfg.Service\tread\tUSINT\t\t14\tGet
AppCfg.Class\t\tUINT\t\t1\t
AppCfg.Instance\t\tUDINT\t\t1\t
AppCfg.Attribute\t\tUINT\t\t7\t
AppCfg.MemberCnt\t\tUSINT\t\t\t
TargetCfg.Path\t\tSTRING\t80\t'4,192.168.1.5'\t
TargetCfg.UcmmTimeout\t\tUDINT\t\t500\t2
";
    let imported = import(text);
    assert_eq!(requests(&imported), ["2..10 192.168.1.5:44818 0e03200124013007"]);
    let config = imported.blocks[0].config.as_msg().unwrap();
    assert_eq!((config.name.as_str(), config.target_cfg.ucmm_timeout), ("message-1", 500));
    assert_eq!(
        told(&imported),
        [
            "2:1: note: AppCfg changes nothing about the message: AppCfg\t\tCIPAPPCFG",
            "7:1: note: AppCfg.MemberCnt without a value changes nothing about the message: AppCfg.MemberCnt\t\tUSINT",
        ]
    );
}
